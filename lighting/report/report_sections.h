// The parts of a stand's report, each as HTML.
#pragma once

#include <filesystem>
#include <string>

#include "lighting/canopy/sensor_canopy.h"
#include "lighting/map/stand_tables.h"

namespace sunfleck::report {

struct Page {
  const StandStudy& study;
  const StandTables& tables;
  const Forest& forest;
  std::filesystem::path scratch;  // for pictures on their way into the page
};

// What was asked, and what is known of the stand.
std::string title_of(const Page& page);
std::string key_figures(const Page& page);
std::string question(const Page& page);
std::string stand_picture(const Page& page, const RunControl& control);
std::string methods(const Page& page);
std::string making(const Page& page);

// The light: maps, profiles, tables.
std::string ground(const Page& page);
std::string profile(const Page& page);
std::string season(const Page& page);
std::string sensors(const Page& page, const RunControl& control);
std::string trees(const Page& page);

// A value of the whole period (row of `target`) with its error; NaN where there is none.
struct Figure {
  double value, error;
};
Figure figure_of(const StandTables& tables, StandTarget target, const std::string& name, std::size_t row = 0);

std::string section(const std::string& id, const std::string& title, const std::string& content);
std::string paragraph(const std::string& text);
std::string sensor_name(const StandTables& tables, std::size_t s);  // escaped

}  // namespace sunfleck::report
