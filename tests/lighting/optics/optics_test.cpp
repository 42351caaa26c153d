// Which optics an element gets, and what is refused.
#include <gtest/gtest.h>

#include "lighting/optics/optics.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

Forest two_species() {
  Forest forest;
  forest.materials = {{"beech", {{"PAR", 0.1, 0.05, 0.2}, {"NIR", 0.45, 0.45, 0.4}}},
                      {"pine", {{"PAR", 0.09, 0.03, 0.1}}}};
  forest.prototypes.resize(2);
  forest.prototypes[0].materials = {"pine", "beech"};
  forest.prototypes[1].materials = {"beech"};
  return forest;
}

TEST(OpticsTable, ResolvesMaterialsPerPrototype) {
  const OpticsTable table(two_species(), {{"PAR"}, {0.15}, {}});
  EXPECT_EQ(table.material(0, PrototypeId{0}, 0).leaf.reflectance_front, 0.09);
  EXPECT_EQ(table.material(0, PrototypeId{0}, 1).leaf.reflectance_back, 0.1);
  EXPECT_EQ(table.material(0, PrototypeId{1}, 0).bark_reflectance, 0.2);
  EXPECT_EQ(table.soil_albedo(0), 0.15);
}

TEST(OpticsTable, OverridesByNameBeforeAll) {
  const MaterialOptics all{{0.2, 0.2, 0.2, 0.2}, 0.3}, beech{{0.4, 0.3, 0.2, 0.1}, 0.5};
  const OpticsTable table(two_species(), {{"NIR"}, {0.2}, {{"*", "NIR", all}, {"beech", "NIR", beech}}});
  EXPECT_EQ(table.material(0, PrototypeId{0}, 0).leaf.transmittance_front, 0.2);
  EXPECT_EQ(table.material(0, PrototypeId{0}, 1).leaf.transmittance_back, 0.1);
}

TEST(OpticsTable, RefusesWithTheFieldAndWhatThereIs) {
  struct Bad {
    OpticsRequest request;
    const char *where, *says;
  };
  const MaterialOptics shining{{0.6, 0.6, 0.6, 0.6}, 0};
  const std::vector<Bad> table = {
      {{{}, {}, {}}, "bands", "at least one"},
      {{{"PAR", "PAR"}, {0.1, 0.1}, {}}, "bands.PAR", "twice"},
      {{{"UV"}, {0.1}, {}}, "bands.UV", "PAR"},
      {{{"NIR"}, {0.1}, {}}, "bands.NIR", "pine"},
      {{{"PAR"}, {}, {}}, "soil_albedo", "one for each"},
      {{{"PAR"}, {1.5}, {}}, "bands.PAR.soil_albedo", "between 0 and 1"},
      {{{"PAR"}, {0.1}, {{"*", "PAR", shining}}}, "bands.PAR.pine", "r + t"},
  };
  for (const Bad& bad : table) {
    try {
      const OpticsTable refused(two_species(), bad.request);
      FAIL() << bad.where;
    } catch (const Error& error) {
      EXPECT_EQ(error.where(), bad.where);
      EXPECT_NE(std::string(error.what()).find(bad.says), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace sunfleck
