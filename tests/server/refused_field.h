// A refusal that names the field and says what would be right, and the table of such cases.
#pragma once

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace sunfleck::test {

// "field: description" of every violation in the details.
inline std::vector<std::string> violations_of(const grpc::Status& status) {
  std::vector<std::string> lines;
  google::rpc::Status details;
  EXPECT_TRUE(details.ParseFromString(status.error_details()));
  for (const auto& detail : details.details()) {
    google::rpc::BadRequest bad;
    if (!detail.UnpackTo(&bad)) continue;
    for (const auto& v : bad.field_violations()) lines.push_back(v.field() + ": " + v.description());
  }
  return lines;
}

inline void expect_refused(const grpc::Status& status, const std::string& field, const std::string& says) {
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT)
      << field << ": " << status.error_message();
  const std::vector<std::string> lines = violations_of(status);
  bool found = false;
  std::string all;
  for (const std::string& line : lines) {
    found = found || (line.rfind(field + ": ", 0) == 0 && line.find(says) != std::string::npos);
    all += "\n  " + line;
  }
  EXPECT_TRUE(found) << "no violation of '" << field << "' that says '" << says << "' among:" << all;
}

template <class Message>
struct Case {
  const char* field;
  const char* says;
  std::function<void(Message&)> spoil;
};

}  // namespace sunfleck::test
