// The shipped species files are whole, and a species file with a mistake is refused.
#include "sim/plant/species.h"

#include <cmath>
#include <cstring>

#include "sim/plant/make_prototype.h"
#include "tests/sim/plant/refusal.h"

namespace sunfleck {
namespace {

SpeciesLibrary shipped() { return SpeciesLibrary::load(test::source_dir() / "configs/species"); }

std::string content_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Species, ShippedFilesHaveParAndNirThatConserveEnergy) {
  const SpeciesLibrary library = shipped();
  ASSERT_GE(library.all().size(), 6u);
  for (const Species& species : library.all()) {
    ASSERT_EQ(species.material.bands.size(), 2u) << species.latin;
    EXPECT_EQ(species.material.name, species.latin);
    EXPECT_EQ(species.material.bands[0].band, "PAR");
    EXPECT_EQ(species.material.bands[1].band, "NIR");
    for (const MaterialBand& band : species.material.bands)
      EXPECT_LE(band.leaf_reflectance + band.leaf_transmittance, 1.0);
  }
}

TEST(Species, FoundByEveryNameThatTheMeasuredStandsUse) {
  const SpeciesLibrary library = shipped();
  const std::pair<const char*, const char*> names[] = {
      {"Fagus sylvatica", "fasy"}, {"fagus", "fasy"}, {"BEECH", "fasy"}, {"Quercus sp.", "quro"},
      {"abies", "abal"},           {"picea", "piab"}, {"piab", "piab"},  {"pseudotsuga", "psme"},
      {"Pinus sylvestris", "pisy"}};
  for (const auto& [name, code] : names) EXPECT_EQ(library.find(name, "t").code, code) << name;
}

// Examples of leaf area that the source of the biomass coefficients states beside them: beech 77.5 m2,
// spruce 81.8 m2, pine 73.3 m2 at dbh 30 cm. Heights: the curve by hand, 1.3 + exp(p + q / 31).
TEST(Species, AllometryGivesTheStatedExamples) {
  const SpeciesLibrary library = shipped();
  const auto at30 = [&](const char* name) { return expected_size(library.find(name, "t"), 30.0); };
  EXPECT_NEAR(at30("fasy").leaf_area_m2, 77.5, 0.1);
  EXPECT_NEAR(at30("piab").leaf_area_m2, 81.8, 0.1);
  EXPECT_NEAR(at30("pisy").leaf_area_m2, 73.3, 0.1);
  EXPECT_NEAR(at30("quro").leaf_area_m2, 76.8, 0.1);
  EXPECT_NEAR(at30("abal").leaf_area_m2, 55.7, 0.1);
  EXPECT_NEAR(at30("bepe").leaf_area_m2, 18.7, 0.1);
  EXPECT_NEAR(at30("lade").leaf_area_m2, 47.3, 0.1);
  EXPECT_NEAR(at30("fasy").height_m, 1.3 + std::exp(3.497 - 16.356 / 31), 1e-12);
  EXPECT_NEAR(at30("fasy").crown_base_m, (1 - 0.733) * at30("fasy").height_m, 1e-12);
  EXPECT_NEAR(at30("piab").crown_radius_m, 0.4699 * std::pow(30.0, 0.5034), 1e-12);
  EXPECT_EQ(at30("piab").dbh_m, 0.3);
  // Pine: 1.3 m + integral of the shaded height increments from 0 to 30 cm, 118.4936 cm * 30^0.8351.
  EXPECT_NEAR(at30("pisy").height_m, 1.3 + 1.184936 * std::pow(30.0, 0.8351), 0.05);
}

TEST(Species, AllButDouglasFirHaveGrammarAndBothForms) {
  const SpeciesLibrary library = shipped();
  ASSERT_EQ(library.all().size(), 8u);
  for (const Species& species : library.all()) {
    const bool whole = species.code != "psme";
    EXPECT_EQ(!species.grammar.empty(), whole) << species.latin;
    EXPECT_EQ(species.open_grown.has_value(), whole) << species.latin;
    EXPECT_EQ(species.demography.has_value(), whole) << species.latin;
    const bool measured = species.code == "pisy" || species.code == "piab" || species.code == "bepe";
    EXPECT_EQ(species.optics_confidence == Confidence::kHigh, measured);
  }
}

// STAR: silhouette area averaged over all directions, per total (twice the one-sided) needle area. A shoot
// is a cylinder of randomly turned needles: a ray over path p is stopped with 1 - exp(-density p / 2). The
// stated value for spruce is 0.14 to 0.16. Midpoint sums over direction and the projected square.
double star_of(const FoliageTemplate& shoot) {
  const double half = 0.5 * shoot.shoot_length_m, radius = shoot.shoot_radius_m;
  const double reach = std::hypot(half, radius);
  constexpr int kDirections = 60, kSide = 200;
  double silhouette_m2 = 0.0;
  for (int d = 0; d < kDirections; ++d) {
    const double mu = (d + 0.5) / kDirections, s = std::sqrt(1 - mu * mu);
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const double a = reach * (2 * (i + 0.5) / kSide - 1), b = reach * (2 * (j + 0.5) / kSide - 1);
        const double chord2 = radius * radius - a * a;  // ray: (-mu b, a, s b) + t (s, 0, mu)
        if (chord2 <= 0) continue;
        const double middle = mu * b / s, chord = std::sqrt(chord2) / s;
        const double path =
            std::min(middle + chord, (half - s * b) / mu) - std::max(middle - chord, (-half - s * b) / mu);
        if (path > 0) silhouette_m2 += 1 - std::exp(-0.5 * shoot.shoot_density_per_m() * path);
      }
  }
  silhouette_m2 *= 4 * reach * reach / (double(kSide) * kSide * kDirections);
  return silhouette_m2 / (2 * shoot.shoot_area_m2());
}

TEST(Species, ShootsHaveTheStatedSilhouette) {
  const SpeciesLibrary library = shipped();
  for (const char* code : {"piab", "abal", "pisy", "lade"}) {
    const double star = star_of(library.find(code, "t").foliage);
    EXPECT_GT(star, 0.14) << code;
    EXPECT_LT(star, 0.16) << code;
  }
}

struct Mistake {
  const char *replace, *by, *where, *problem, *remedy;
};

TEST(Species, MistakesAreRefusedWithLineAndRemedy) {
  const std::string good = content_of(test::source_dir() / "configs/species/fagus_sylvatica.toml");
  const Mistake mistakes[] = {
      {"leaf_transmittance = 0.47", "leaf_transmittance = 0.57", "leaf_transmittance", "more than 1",
       "lower"},
      {"leaf_reflectance = 0.44", "leaf_reflectance = 1.44", "optics.band[1].leaf_reflectance", "1.44",
       "0 to 1"},
      {"leaf_reflectance = 0.44", "leaf_reflectance = nan", "optics.band[1].leaf_reflectance", "nan",
       "0 to 1"},
      {"name = \"NIR\"", "name = \"PAR\"", "optics.band[1].name", "given twice", "remove"},
      {"leaf_length_m = 0.075", "leaf_lenght_m = 0.075", "foliage.leaf_length_m", "missing", "add"},
      {"leaf_width_m = 0.05", "leaf_width_m = -0.05", "foliage.leaf_width_m", "-0.05", "from"},
      {"kind = \"leaf\"", "kind = \"fern\"", "foliage.kind", "\"fern\"", "\"leaf\", \"shoot\""},
      {"angles = \"planophile\"", "angles = \"planar\"", "foliage.angles", "\"planar\"", "spherical"},
      {"length_ratio = 0.733", "length_ratio = 1.733", "crown.length_ratio", "1.733", "to 1"},
      {"code = \"fasy\"", "code = \"fasy\"\ncolour = 3", ":3: colour", "unknown key", "known here"},
      {"code = \"fasy\"", "code = 7", ":2: code", "integer", "text"},
  };
  for (const Mistake& m : mistakes) {
    std::string text = good;
    const std::size_t at = text.find(m.replace);
    ASSERT_NE(at, std::string::npos) << m.replace;
    const auto path = test::write_scratch("bad.toml", text.replace(at, std::strlen(m.replace), m.by));
    test::expect_refused([&] { load_species(path); }, ErrorKind::kInvalidInput, m.where, m.problem, m.remedy);
  }
}

TEST(Species, EveryTableMustNameItsSource) {
  const std::string good = content_of(test::source_dir() / "configs/species/picea_abies.toml");
  int removed = 0;
  for (std::size_t at = good.find("source = "); at != std::string::npos;
       at = good.find("source = ", at + 1)) {
    const std::size_t begin = good.rfind('\n', at) + 1, end = good.find('\n', at);
    const auto path = test::write_scratch("unsourced.toml", good.substr(0, begin) + good.substr(end + 1));
    test::expect_refused([&] { load_species(path); }, ErrorKind::kInvalidInput, "source", "missing", "add");
    ++removed;
  }
  EXPECT_EQ(removed, 14);
}

TEST(Species, LibraryRefusesUnknownNamesEmptyFoldersAndSharedNames) {
  const SpeciesLibrary library = shipped();
  test::expect_refused([&] { library.find("Ginkgo", "inv.csv:3, species"); }, ErrorKind::kInvalidInput,
                       "inv.csv:3, species", "Ginkgo", "Fagus sylvatica");
  test::expect_refused([] { SpeciesLibrary::load(test::scratch_dir() / "nowhere"); }, ErrorKind::kNotFound,
                       "nowhere", "folder", "configs/species");
  const auto folder = test::scratch_dir() / "twins";
  std::filesystem::create_directories(folder);
  test::expect_refused([&] { SpeciesLibrary::load(folder); }, ErrorKind::kNotFound, "twins",
                       "no species file", "configs/species");
  std::string twin = content_of(test::source_dir() / "configs/species/abies_alba.toml");
  test::write_scratch("twins/a.toml", twin);
  test::write_scratch("twins/b.toml",
                      twin.replace(twin.find("latin = \"Abies alba\""), 20, "latin = \"Abies nova\""));
  test::expect_refused([&] { SpeciesLibrary::load(folder); }, ErrorKind::kInvalidInput, "b.toml",
                       "already means Abies alba", "one species");
}

TEST(Species, ImpossibleDiametersAreRefused) {
  const SpeciesLibrary library = shipped();
  for (const double dbh_cm : {0.0, -3.0, 2000.0, std::nan(""), HUGE_VAL})
    test::expect_refused([&] { expected_size(library.all()[0], dbh_cm); }, ErrorKind::kInvalidInput, "dbh_cm",
                         "no stem diameter", "above 0");
}

}  // namespace
}  // namespace sunfleck
