// The report of a small stand: well-formed, self-contained, every number in it, nothing a user wrote becomes
// mark-up; and what a browser shows of it is not blank. Pictures and photographs beside it.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <set>

#include "lighting/render/photograph_file.h"
#include "lighting/report/html.h"
#include "lighting/report/stand_photographs.h"
#include "lighting/report/stand_pictures.h"
#include "lighting/report/stand_report.h"
#include "lighting/report/sun_path_picture.h"
#include "sim/base/error.h"
#include "tests/lighting/map/example_study.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;
using test::example_study;

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

const fs::path& saved() {
  static const fs::path path = [] {
    const auto& e = example_study();
    fs::path file = test::scratch_dir() / "report.html";
    save_stand_report(e.study, e.tables, e.forest, file, {});
    return file;
  }();
  return path;
}

// Without the bytes of pictures: std::regex would run out of stack in them.
std::string without_pictures(const std::string& page) {
  std::string out;
  std::size_t from = 0;
  for (std::size_t at; (at = page.find("base64,", from)) != std::string::npos; from = page.find('"', at))
    out += page.substr(from, at + 7 - from);
  return out + page.substr(from);
}

// The page without its pictures.
std::string words() {
  static const std::string text = without_pictures(content(saved()));
  return text;
}

// Every element is closed in order; returns the first offence.
std::string first_unbalanced(const std::string& html) {
  const std::set<std::string> empty = {"meta", "img", "br"};
  std::vector<std::string> open;
  const std::regex tag("<(/?)([a-zA-Z][a-zA-Z0-9]*)([^>]*)>");
  for (std::sregex_iterator i(html.begin(), html.end(), tag), end; i != end; ++i) {
    const std::string name = (*i)[2];
    if (empty.contains(name)) continue;
    if ((*i)[1].length() == 0) {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return "</" + name + "> closes " + (open.empty() ? "nothing" : open.back());
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : open.back() + " stays open";
}

TEST(StandReport, IsWellFormedAndNeedsNothingFromOutside) {
  const std::string page = words();
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  EXPECT_EQ(first_unbalanced(page), "");
  for (const char* outside : {"http:", "https:", "<script", "<link", "@import", "url("})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = page.find("src=\"", at)) != std::string::npos; ++at, ++pictures)
    EXPECT_EQ(page.substr(at + 5, 11), "data:image/");
  // Stand, ground, profile, projection, season, scatter, three photographs.
  EXPECT_EQ(pictures, 9u);
  std::set<std::string> ids;
  const std::regex id("id=\"([^\"]+)\"");
  for (std::sregex_iterator i(page.begin(), page.end(), id), end; i != end; ++i)
    EXPECT_TRUE(ids.insert((*i)[1]).second) << (*i)[1];
  const std::regex link("href=\"#([^\"]+)\"");
  std::size_t links = 0;
  for (std::sregex_iterator i(page.begin(), page.end(), link), end; i != end; ++i, ++links)
    EXPECT_TRUE(ids.contains((*i)[1])) << (*i)[1];
  EXPECT_EQ(links, 9u);
}

TEST(StandReport, WhatUsersWroteStaysText) {
  const std::string page = words();
  EXPECT_EQ(page.find("<b>\"ash"), std::string::npos);
  EXPECT_NE(page.find("&lt;b&gt;&quot;ash, &amp; oak&quot;&lt;/b&gt;"), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
  EXPECT_EQ(page.find(">inf"), std::string::npos);
}

TEST(StandReport, HoldsEveryNumber) {
  const std::string page = words();
  const StandTables& t = example_study().tables;
  const auto expect = [&](const std::string& cell) { EXPECT_NE(page.find(cell), std::string::npos) << cell; };
  const auto percent = [&](StandTarget target, const char* name, std::size_t k) {
    const StandVariable& v = *t.find(target, name);
    return html::number_with_error(v.value[k], v.standard_error.empty() ? 0 : v.standard_error[k], 1, 100);
  };
  for (std::size_t i = 0; i < t.intervals.size(); ++i)
    for (const char* name : {"absorbed_fraction_par", "albedo_par", "transmittance_par"})
      expect("<td>" + percent(StandTarget::kPlot, name, i) + "</td>");
  for (std::size_t s = 0; s < 3; ++s)
    for (const char* name : {"pacl_total", "pacl_direct", "pacl_diffuse", "openness", "sky_view_factor",
                             "gap_light_index", "direct_site_factor", "indirect_site_factor"})
      expect("<td>" + percent(StandTarget::kSensor, name, s) + "</td>");
  const StandVariable& gaps = *t.find(StandTarget::kSensor, "gap_fraction");
  for (std::size_t k = 0; k < gaps.value.size(); ++k)
    expect("<td>" + html::number_with_error(gaps.value[k], gaps.standard_error[k], 1, 100) + "</td>");
  const StandVariable& mol = *t.find(StandTarget::kTree, "absorbed_par_photons");
  for (std::size_t k = 0; k < t.trees.size(); ++k) {
    expect("<td class=\"l\">" + std::to_string(t.trees[k].id) + "</td>");
    expect(html::figure(t.trees[k].leaf_area_m2));
    expect(html::figure(mol.value[k]) + "&nbsp;&plusmn;&nbsp;" + html::figure(mol.standard_error[k]));
  }
  expect(html::number(t.find(StandTarget::kPlot, "leaf_area_index")->value[0], 2));
  expect("RMSE " + html::number(example_study().study.fit->rmse, 3));
  expect(t.provenance.forest_hash);
}

TEST(StandReport, LargeStandsAndPolarNightsHavePagesToo) {
  StandStudySpec spec = test::example_study_spec();
  spec.engine = StandEngine::kBoxes;
  spec.map_lo_m.reset(), spec.map_hi_m.reset();
  const StandStudy boxes = run_stand_study(example_study().forest, spec, {});
  const fs::path file = test::scratch_dir() / "boxes.html";
  save_stand_report(boxes, stand_tables(boxes, example_study().forest), example_study().forest, file, {});
  EXPECT_NE(content(file).find("Large stand"), std::string::npos);
  spec = test::example_study_spec();
  spec.place = {80, 15};
  spec.intervals = IntervalKind::kDay;
  spec.period = parse_period("2020-12-05T00:00Z", "2020-12-08T00:00Z", "stand_light");
  std::ofstream(spec.radiation) << "month,global_horizontal_mj_m2,diffuse_fraction\n12,0,0.5\n";
  const StandStudy night = run_stand_study(example_study().forest, spec, {});
  save_stand_report(night, stand_tables(night, example_study().forest), example_study().forest, file, {});
  EXPECT_EQ(first_unbalanced(without_pictures(content(file))), "");
  EXPECT_THROW(save_stand_report(night, stand_tables(night, example_study().forest), example_study().forest,
                                 "/nonexistent/r.html", {}),
               Error);
}

std::vector<std::uint8_t> pixels_of(const fs::path& png, int& width, int& height, int& channels) {
  const auto in = OIIO::ImageInput::open(png.string());
  EXPECT_TRUE(in) << png;
  if (!in) return {};
  width = in->spec().width, height = in->spec().height, channels = in->spec().nchannels;
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width * height * channels));
  EXPECT_TRUE(in->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, pixels.data()));
  return pixels;
}

// Dark text, green leaves and pale paper each cover a share of what headless Chromium shows.
TEST(StandReport, ABrowserShowsIt) {
  if (std::system("command -v chromium > /dev/null 2>&1") != 0) {
    std::fprintf(stderr,
                 "\n*** SKIPPED: chromium is not here; the report was not looked at in a browser ***\n\n");
    GTEST_SKIP();
  }
  const fs::path shot = test::scratch_dir() / "shot.png";
  const std::string command =
      "timeout 120 chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
      "--disable-background-networking --disable-component-update --disable-sync --hide-scrollbars "
      "--user-data-dir='" +
      (test::scratch_dir() / "profile").string() + "' --window-size=1000,3000 --screenshot='" +
      shot.string() + "' 'file://" + saved().string() + "' > /dev/null 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  int width = 0, height = 0, channels = 0;
  const auto pixels = pixels_of(shot, width, height, channels);
  ASSERT_EQ(width, 1000);
  std::size_t dark = 0, green = 0, pale = 0;
  for (std::size_t p = 0; p + 2 < pixels.size(); p += static_cast<std::size_t>(channels)) {
    const int r = pixels[p], g = pixels[p + 1], b = pixels[p + 2];
    dark += r + g + b < 200;
    green += g > r + 20 && g > b + 20;
    pale += r + g + b > 720;
  }
  const auto all = static_cast<double>(width) * height;
  EXPECT_GT(static_cast<double>(dark) / all, 0.003);   // text
  EXPECT_GT(static_cast<double>(green) / all, 0.004);  // the stand, the map, the profile: 0.01 seen
  EXPECT_GT(static_cast<double>(pale) / all, 0.3);     // paper
}

TEST(StandPictures, EveryPictureIsThere) {
  const auto& e = example_study();
  const fs::path folder = test::scratch_dir() / "pictures";
  const auto written = save_stand_pictures(e.study, e.tables, folder);
  EXPECT_EQ(written.size(), 5u);
  for (const fs::path& path : written) {
    EXPECT_EQ(content(path).substr(1, 3), "PNG") << path;
  }
  // The scatter's axes are the same and hold all points with their errors.
  const PlotPage scatter = *scatter_plot(e.study, e.tables);
  const PlotPanel& panel = scatter.panels.front();
  EXPECT_EQ(panel.x.to, panel.y.to);
  EXPECT_EQ(panel.series[1].y[2], 100 * e.tables.find(StandTarget::kSensor, "pacl_total")->value[2]);
  EXPECT_TRUE(std::isnan(panel.series[1].x[1]));
}

TEST(StandPhotographs, HaveNamesOfTheirOwnAndTheSensorsSky) {
  const auto& e = example_study();
  StandStudySpec spec = e.study.spec;
  spec.sensors.push_back(spec.sensors[2]);  // the same name a second time
  const auto written = save_photographs(e.forest, spec, 64, test::scratch_dir() / "photographs", {});
  ASSERT_EQ(written.size(), 8u);
  EXPECT_EQ(std::set<fs::path>(written.begin(), written.end()).size(), 8u);
  EXPECT_EQ(written[4].filename(), "sensor_third.png");
  EXPECT_EQ(written[5].filename(), "sensor_third_sun_paths.png");
  spec.sensors.clear();
  EXPECT_THROW(save_photographs(e.forest, spec, 64, test::scratch_dir() / "photographs", {}), Error);
}

// Seen from below, east is on the left; the sun of midsummer noon stands 50 - 23.44 degrees south of the
// zenith.
TEST(SunPaths, LieWhereTheSunStands) {
  EXPECT_NEAR(place_in_photograph(0.5 * kPi, 0.5 * kPi).x, -1, 1e-12);
  EXPECT_NEAR(place_in_photograph(0, 0.25 * kPi).y, 0.5, 1e-12);
  const std::vector<SunPath> paths = sun_paths({50, 0, 0}, 2021, 0);
  ASSERT_EQ(paths.size(), 4u);
  const auto at_hour = [](const SunPath& path, int hour) {
    for (const SunPath::Point& p : path.points)
      if (p.hour == hour) return p.at;
    ADD_FAILURE() << hour;
    return Vec2(0);
  };
  for (const auto& [path, zenith_deg] : {std::pair{0, 50.0}, {1, 26.56}, {2, 49.8}, {3, 73.44}}) {
    // The sun's clock is up to 7 minutes, 2 degrees, off on these days; near the zenith 3 degrees of azimuth.
    const Vec2 noon = at_hour(paths[static_cast<std::size_t>(path)], 12);
    EXPECT_NEAR(noon.y, -zenith_deg / 90, 0.004) << path;
    EXPECT_NEAR(noon.x, 0, 0.03) << path;
  }
  EXPECT_LT(at_hour(paths[1], 8).x, -0.3);  // mornings in the east
  EXPECT_GT(at_hour(paths[1], 16).x, 0.3);
  // The hours move with the clock, the way of the sun does not.
  const Vec2 later = at_hour(sun_paths({50, 0, 0}, 2021, 60)[1], 13);
  EXPECT_NEAR(later.x, at_hour(paths[1], 12).x, 1e-3);
  const std::vector<SunPath> polar = sun_paths({85, 0, 0}, 2021, 0);
  EXPECT_TRUE(polar[3].points.empty());
  EXPECT_EQ(polar[1].points.size(), 24u * 12 + 1);
}

// The coloured ways are there, at the right place: over an open sky, the pixel of midsummer noon is no grey.
TEST(SunPaths, AreDrawnOverThePhotograph) {
  const HemisphericalPhotograph open{200, std::vector<float>(200 * 200, 0.6f)};
  const fs::path with = test::scratch_dir() / "paths.png", bare = test::scratch_dir() / "bare.png";
  draw_sun_paths(open, sun_paths({50, 0, 0}, 2021, 0), "a \"sensor\"", with);
  draw_sun_paths(open, sun_paths({85, 0, 0}, 2021, 0), "polar", bare);  // midwinter has no way there
  int width = 0, height = 0, channels = 0;
  const auto pixels = pixels_of(with, width, height, channels);
  ASSERT_GE(channels, 3);
  std::size_t coloured_south = 0, coloured_north = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto p = static_cast<std::size_t>((y * width + x) * channels);
      const int low = std::min({pixels[p], pixels[p + 1], pixels[p + 2]}),
                high = std::max({pixels[p], pixels[p + 1], pixels[p + 2]});
      const bool in_picture = std::hypot(x - width / 2, y - height / 2) < width / 3;
      if (high - low > 80 && in_picture) (y > height / 2 ? coloured_south : coloured_north) += 1;
    }
  EXPECT_GT(coloured_south, 300u);
  EXPECT_GT(coloured_south, 3 * coloured_north);  // at 50 degrees north the sun walks through the south
  EXPECT_THROW(draw_sun_paths(open, {}, "t", test::scratch_dir() / "a.svg"), Error);
}

// A quarter of sky at the north-east of the picture, half a share beside it.
TEST(StandPhotographs, GreyIsTheShareOfSky) {
  HemisphericalPhotograph photograph{8, std::vector<float>(64, 0.0f)};
  photograph.sky[1 * 8 + 2] = 1.0f;
  photograph.sky[1 * 8 + 3] = 0.5f;
  const fs::path file = test::scratch_dir() / "grey.png";
  save_png(photograph, file);
  int width = 0, height = 0, channels = 0;
  const auto pixels = pixels_of(file, width, height, channels);
  ASSERT_EQ(pixels.size(), 64u);
  EXPECT_EQ(pixels[10], 255);
  EXPECT_EQ(pixels[11], 128);
  EXPECT_EQ(pixels[12], 0);
}

}  // namespace
}  // namespace sunfleck
