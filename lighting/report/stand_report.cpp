#include "lighting/report/stand_report.h"

#include <stdlib.h>

#include "lighting/report/html.h"
#include "lighting/report/report_sections.h"
#include "lighting/report/report_style.h"
#include "lighting/sky/utc_time.h"
#include "sim/base/pending_file.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;

// A folder for pictures on their way into the page, gone at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "sunfleck-report-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw_cannot_write(name, "no folder can be made there");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string header_of(const report::Page& page) {
  const StandTables& t = page.tables;
  return "<header><h1>" + report::title_of(page) + "</h1>\n<p>" +
         html::escaped(local_time_text(t.begin_s[0], t.utc_offset_minutes)) + " to " +
         html::escaped(local_time_text(t.end_s[0], t.utc_offset_minutes)) + "</p>\n";
}

struct Section {
  const char *id, *title;
  std::string content;
};

// The links at the top lead to the sections that are there.
std::string assemble(const report::Page& page, const std::vector<Section>& sections) {
  std::string links = "<nav>", body;
  for (const Section& s : sections) {
    if (s.content.empty()) continue;
    links += "<a href=\"#" + std::string(s.id) + "\">" + s.title + "</a>";
    body += report::section(s.id, s.title, s.content);
  }
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         report::title_of(page) + "</title>\n<style>" + report::kStyle + "</style></head>\n<body><main>\n" +
         header_of(page) + links + "</nav></header>\n" + report::key_figures(page) + body +
         "</main></body></html>\n";
}

}  // namespace

void save_stand_report(const StandStudy& study, const StandTables& tables, const Forest& forest,
                       const std::filesystem::path& path, const RunControl& control) {
  const ScratchFolder scratch;
  const report::Page page{study, tables, forest, scratch.path()};
  write_whole_file(path, assemble(page, {{"question", "What was asked", report::question(page)},
                                         {"stand", "The stand", report::stand_picture(page, control)},
                                         {"ground", "Light on the ground", report::ground(page)},
                                         {"profile", "From the top to the ground", report::profile(page)},
                                         {"season", "The season", report::season(page)},
                                         {"sensors", "Sensors", report::sensors(page, control)},
                                         {"trees", "Trees", report::trees(page)},
                                         {"methods", "Methods and errors", report::methods(page)},
                                         {"making", "Notes and what was skipped", report::making(page)}}));
}

}  // namespace sunfleck
