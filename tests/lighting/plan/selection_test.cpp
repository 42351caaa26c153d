// A selection gives its trees the light they have in the whole forest, and refuses trees that are not there.
#include "lighting/plan/selection.h"

#include <gtest/gtest.h>

#include <cstring>

#include "lighting/base/summaries.h"
#include "lighting/plan/light_session.h"
#include "sim/base/error.h"
#include "tests/lighting/plan/auto_scenes.h"

namespace sunfleck::test {
namespace {

Forest stand() {
  Forest forest = small_stand();
  for (std::uint32_t i = 0; i < forest.instances.size(); ++i) forest.instances[i].tree = TreeId{100 + i / 2};
  return forest;
}

TEST(Selection, HoldsTheLightOfItsTreesInTheWholeForest) {
  const Forest forest = stand();
  const LightSession session(forest);
  for (const Method method : {Method::kReference, Method::kGrid, Method::kAuto}) {
    LightRequest r = sun_and_sky(method);
    r.reference.rays_per_face = r.reference.sun_rays_per_element = 8;
    r.automatic.tolerance = 0.5;
    const LightMap whole = session.compute(r, {}, {});
    r.selection = {{TreeId{101}}, {7, 3}};  // tree 101 is instances 2 and 3
    const LightMap part = session.compute(r, {}, {});
    const Forest selected = selected_forest(forest, r.selection);
    ASSERT_EQ(selected.instances.size(), 3u);
    EXPECT_EQ(find_violation(part, ForestIndex(selected)), "");
    const ForestIndex index(forest), selected_index(selected);
    for (const auto& [k, i] : {std::pair{0u, 2u}, {1u, 3u}, {2u, 7u}}) {
      const std::size_t count = index.first_element(i + 1) - index.first_element(i);
      EXPECT_EQ(std::memcmp(&part.bands[1].elements[selected_index.first_element(k)],
                            &whole.bands[1].elements[index.first_element(i)], count * sizeof(ElementLight)),
                0);
      EXPECT_EQ(part.bands[1].trees[k].absorbed_w, whole.bands[1].trees[i].absorbed_w);
      EXPECT_EQ(part.bands[1].trees[k].tree, forest.instances[i].tree);
      EXPECT_EQ(part.bands[1].trees[k].instance, k);
    }
  }
}

TEST(Selection, RefusesWhatIsNotThereBeforeAnyWork) {
  const Forest forest = stand();
  const LightSession session(forest);
  for (const auto& [where, selection] :
       {std::pair<std::string, Selection>{"selection.trees[1]", {{TreeId{100}, TreeId{999}}, {}}},
        {"selection.instances[0]", {{}, {9}}}}) {
    LightRequest r = sun_and_sky(Method::kReference);
    r.selection = selection;
    bool worked = false;
    try {
      session.compute(r, {}, {{}, [&](std::string_view, double) { worked = true; }});
      FAIL() << where;
    } catch (const Error& e) {
      EXPECT_EQ(e.where(), where);
      EXPECT_FALSE(e.remedy().empty());
    }
    EXPECT_FALSE(worked);
  }
}

}  // namespace
}  // namespace sunfleck::test
