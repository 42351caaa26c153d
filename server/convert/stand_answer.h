// Stand studies between lighting/study and the wire: tables as arrays, the rest as the summary. Names of the
// arrays: proto/sunfleck/v1/stand_light.proto.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "lighting/study/stand_study.h"
#include "server/convert/array_message.h"

namespace sunfleck {

namespace v1 {
class StandLightSummary;
}

// Views of the study's tables, and the columns that had to be gathered.
class StandArrays {
 public:
  // `forest`: the one of the study, needed while this is made; null: without the array "plot".
  StandArrays(std::shared_ptr<const StandStudy> study, const Forest* forest);
  StandArrays(const StandArrays&) = delete;
  StandArrays& operator=(const StandArrays&) = delete;

  const StandStudy& study() const { return *study_; }
  const std::vector<ArrayView>& views() const { return views_; }
  std::uint64_t size_bytes() const;

 private:
  void add_canopy(const std::vector<SensorCanopy>& canopy);
  void add_plot(const Forest& forest);
  const std::shared_ptr<const StandStudy> study_;
  std::deque<std::vector<double>> gathered_;  // stay where they are
  std::vector<std::uint32_t> tree_ids_;
  std::vector<ArrayView> views_;
};

void fill_summary(const StandArrays& arrays, v1::StandLightSummary& message);

// The study that answered `spec`, bit by bit. Throws Error(kInputOutput) if arrays and summary do not fit
// together.
StandStudy stand_study_from_messages(const std::vector<ReceivedArray>& arrays,
                                     const v1::StandLightSummary& summary, const StandStudySpec& spec);

}  // namespace sunfleck
