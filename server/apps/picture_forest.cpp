#include "server/apps/picture_forest.h"

#include "lighting/render/loaded_light.h"
#include "lighting/render/seen_trees.h"
#include "server/apps/terminal.h"
#include "sim/base/error.h"
#include "sim/grid/forest_file.h"

namespace sunfleck {
namespace {

Box bounds_of(const ForestOutline& forest) {
  Box all;
  for (const Box& box : instance_boxes(forest))
    if (!box.empty()) all.include(box);
  return all;
}

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100 * share);
  return text;
}

std::string note_of(const TreeSelection& selection) {
  const std::string trees = grouped(selection.trees_needed) + " of " + grouped(selection.trees.size()) +
                            " trees (" + grouped(selection.prototypes_needed) + " of " +
                            grouped(selection.prototypes.size()) + " prototypes)";
  const std::string why = ": " + grouped(selection.trees_seen) + " in view, " + selection.reason + "; ";
  if (selection.light_bound == 0.0) return trees + why + "the picture is the one of all trees";
  return trees + why + "no surface's light changes by more than " + percent(selection.light_bound) +
         " of an open place's";
}

PictureForest load_whole(const std::filesystem::path& path,
                         const std::function<RenderRequest(const Box&)>& request_for) {
  PictureForest picture;
  picture.forest = load_forest(path);
  picture.request = request_for(forest_bounds(picture.forest));
  picture.content_hash = content_hash(picture.forest);
  picture.note = "all " + grouped(picture.forest.instances.size()) +
                 " trees: the file, of an earlier version, does not state what they fill";
  return picture;
}

}  // namespace

LightMap PictureForest::light(LightMap of_whole) const {
  return whole ? light_of_loaded(std::move(of_whole), *whole, loaded) : std::move(of_whole);
}

PictureForest load_for_picture(const std::filesystem::path& path, RenderMode mode, double far_light,
                               const std::function<RenderRequest(const Box&)>& request_for) {
  const std::optional<ForestSketch> sketch = read_sketch(path);
  if (!sketch) return load_whole(path, request_for);
  PictureForest picture;
  picture.request = request_for(bounds_of(sketch->outline));
  const TreeSelection selection = trees_for_picture(sketch->outline, sketch->description.forest.materials,
                                                    picture.request, mode, far_light);
  picture.forest = load_prototypes(*sketch, selection.prototypes);
  picture.content_hash = sketch->content_hash();
  picture.note = note_of(selection);
  picture.whole = sketch->outline;
  picture.loaded = selection.prototypes;
  return picture;
}

}  // namespace sunfleck
