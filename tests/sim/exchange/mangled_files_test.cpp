// Every reader of text files, given files that were right and then mangled: bytes flipped, cut, doubled,
// numbers replaced by impossible ones. Each must be read or refused by an Error that says what is wrong; what
// is read must be sound. Run under the sanitizers this looks for reads beyond the end and casts that cannot
// be. Seeds are fixed.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "sim/base/random.h"
#include "sim/config/config_table.h"
#include "sim/exchange/qsm.h"
#include "sim/forest/forest_spec.h"
#include "sim/forest/inventory.h"
#include "sim/forest/plot_polygon.h"
#include "sim/lsystem/lsystem.h"
#include "sim/plant/make_prototype.h"
#include "tests/sim/plant/refusal.h"

namespace sunfleck {
namespace {

constexpr int kMangledPerFile = 400;

constexpr std::array<std::string_view, 14> kStrange = {"nan",
                                                       "-inf",
                                                       "1e308",
                                                       "-1e308",
                                                       "1e-320",
                                                       "0",
                                                       "-1",
                                                       "4294967296",
                                                       "9223372036854775807",
                                                       "",
                                                       "\"",
                                                       "(((",
                                                       std::string_view("\0", 1),
                                                       "\xff\xfe"};

// One to four changes of a text.
std::string mangled(std::string text, std::uint64_t seed) {
  RandomStream random(seed, text.size(), RandomPurpose::kTestScene);
  const auto place = [&] { return random.below(static_cast<std::uint32_t>(text.size()) + 1); };
  for (std::uint32_t changes = 1 + random.below(4); changes > 0; --changes) {
    const std::size_t at = place(), length = 1 + random.below(12);
    switch (random.below(5)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(random.below(256));
        break;
      case 1:
        text.resize(at);
        break;
      case 2:
        text.erase(at, length);
        break;
      case 3:
        text.insert(place(), text.substr(at, 4 * length));
        break;
      default: {  // the number or word at this place
        const std::size_t end = std::min(text.find_first_of(" ,;\n()=", at), text.size());
        text.replace(at, end - at, kStrange[random.below(kStrange.size())]);
      }
    }
  }
  return text;
}

// How many of the mangled texts were read; `read` throws Error for the others.
int read_mangled(const std::string& text, const std::function<void(const std::string&)>& read) {
  EXPECT_NO_THROW(read(text)) << "the whole one";
  int accepted = 0;
  for (int seed = 0; seed < kMangledPerFile; ++seed) {
    const std::string given = mangled(text, static_cast<std::uint64_t>(seed));
    try {
      read(given);
      ++accepted;
    } catch (const Error& error) {
      EXPECT_FALSE(error.problem().empty()) << given;
    } catch (const std::exception& other) {
      ADD_FAILURE() << other.what() << " (seed " << seed << ") from:\n" << given;
    }
  }
  EXPECT_LT(accepted, kMangledPerFile) << "nothing was refused";
  return accepted;
}

constexpr const char* kObj =
    "mtllib a.mtl\nv 0 0 1\nv 2 0 1\nv 2 1 1\nv 0 1 1\nv 1 3 1.5\nusemtl leaf\nf 1 2 3 4\nf 1/1 2/1/1 3//1\n"
    "f -5 -4 -3 -1 -2\nusemtl bark\nf 1 2 5\n";

TEST(MangledFiles, Meshes) {
  const MeshMaterials materials{{{"leaf", "Fagus sylvatica"}}, {{"bark", "Fagus sylvatica"}}};
  read_mangled(kObj, [&](const std::string& text) {
    const Prototype tree = import_mesh(test::write_scratch("tree.obj", text), materials);
    validate(tree, "tree");
  });
  const MeshMaterials any{{{"", "leaf"}}, {}};
  read_mangled(
      "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty uchar red\n"
      "property double y\nproperty float z\nelement edge 1\nproperty list uchar short ends\nelement face 2\n"
      "property list uchar uint vertex_indices\nend_header\n0 9 0 1\n2 9 0 1\n2 9 1 1\n0 9 1 1\n2 0 1\n"
      "4 0 1 2 3\n3 0 1 2\n",
      [&](const std::string& text) {
        validate(import_mesh(test::write_scratch("tree.ply", text), any), "tree");
      });
}

TEST(MangledFiles, LeafListsAndCylinders) {
  read_mangled("# leaves\n0.5 1 2 3 0 0 2\n0 0 1 2 0 1 3 1 1 1 1 1\n0.1 -1 0 4 0.2 0.3 1\n",
               [](const std::string& text) {
                 validate(import_leaf_list(test::write_scratch("leaves.txt", text), "leaf"), "tree");
               });
  read_mangled(
      "id,parent_id,start_x_m,start_y_m,start_z_m,end_x_m,end_y_m,end_z_m,radius_m\n"
      "1,0,0,0,0,0,0,2,0.1\n2,1,0,0,2,1,0,2,0.05\n3,2,1,0,2,2,0,3,0.01\n",
      [](const std::string& text) {
        validate(import_qsm(test::write_scratch("tree.csv", text), "Fagus sylvatica"), "tree");
      });
}

TEST(MangledFiles, TablesOfTrees) {
  read_mangled(
      "id_tree;species;x;y;dbh_cm;h_m;hbase_m;rn_m;re_m;rs_m;rw_m;crown_type\n"
      "1;Fagus sylvatica;0.5;1;20;14;5;2;2;2;2;E\n2;\"Picea; abies\";3;1.5;31.5;;;1;2;3;4;8E\n",
      [](const std::string& text) {
        const InventoryReading reading = examine_inventory(text, "trees.csv");
        if (reading.has_errors()) throw_invalid("trees.csv", "has errors", "none");
      });
  read_mangled("x,y\n0,0\n10,0\n10.5,8\n-1,7e0\n",
               [](const std::string& text) { parse_plot_polygon(text, "plot.csv"); });
}

TEST(MangledFiles, Scenes) {
  read_mangled(
      "[forest]\nname = \"f\"\nseed = 3\ntrees = \"crown\"\nplot_width_m = 30.5\nplot_depth_m = 2e1\n"
      "[[forest.planting]]\nspecies = \"Fagus sylvatica\"\ncount = 12\nspacing_m = 2\npattern = \"rows\"\n"
      "[forest.clumps]\nradius_m = 0.5\n[forest.terrain]\nslope_deg = 5\n[forest.period]\nsize_x_m = 30\n"
      "size_y_m = 20\n",
      [](const std::string& text) {
        const ConfigTable table = ConfigTable::from_text(text, "scene.toml");
        read_forest_spec(table.table("forest"));
        table.reject_unread();
      });
}

TEST(MangledFiles, Grammars) {
  const char* const grammars[] = {
      "#define R 0.9\nsymbols: A(2) B(2) Leaf\norgans: Leaf\nsteps: 4\naxiom: A(1, 0.1)\n"
      "A(l, w) : l > 0.01 --> !(w) F(l) [ &(45) B(l*0.6, w*0.7) ] /(137.5) A(l*R, w*0.7)\n"
      "B(l, w) --> !(w) F(l) [ -(45) $ B(l*0.6, w*0.7) ] { F . + F . } Leaf ;(2) : 2\n",
      "symbols: S T(1)\nignore: + -\nschedule: a*2 b\naxiom: S F F [ + F ] T(3)\ngroup: a\n"
      "S < F > F --> F S : 0.5\nF > T(n) : {k = n+1} k < 9 --> F T(k)\ngroup: b\nF --> ?P(0,0,0) F\n"
      "decomposition:\nmaximum depth: 7\nT(n) : n > 1 --> T(n-1) F\ninterpretation:\nS --> F(0.5) %\n",
      "timed: a(1)\naxiom: a(0) @begin(two) F(1) @end\nlsystem: two\nF(x) --> F(x*2) F(ran(x))\n"
      "endlsystem:\ntimed rules:\na(t) : until 2 --> a(0) F(t)\n"};
  for (const char* grammar : grammars)
    read_mangled(grammar, [](const std::string& text) {
      const lsystem::Grammar read = lsystem::Grammar::parse(text, "g.lsys");
      lsystem::DeriveOptions options;
      options.steps = 3;
      options.max_modules = 3000;
      read.interpret(read.advance(read.axiom(), 2.5, options), lsystem::StartFrame::kTree, options);
      read.interpret(read.derive(options), lsystem::StartFrame::kTree, options);
    });
}

}  // namespace
}  // namespace sunfleck
