#include "sim/forest/plane_coordinates.h"

#include <cmath>
#include <cstdio>

#include "sim/base/vec.h"

namespace sunfleck {

std::string to_plane_coordinates(std::vector<InventoryTree>& trees) {
  double longitude_deg = 0, latitude_deg = 0;
  // Differences to the first tree keep stands on the date line together.
  const double first_deg = trees.front().x_m;
  for (InventoryTree& tree : trees) {
    tree.x_m -= first_deg;
    if (tree.x_m > 180) tree.x_m -= 360;
    if (tree.x_m < -180) tree.x_m += 360;
    longitude_deg += tree.x_m / static_cast<double>(trees.size());
    latitude_deg += tree.y_m / static_cast<double>(trees.size());
  }
  // WGS84: semi-major axis and squared eccentricity; radii of the meridian and of the prime vertical.
  constexpr double kSemiMajorM = 6378137.0, kEccentricity2 = 6.69437999014e-3;
  const double s = std::sin(radians_from_degrees(latitude_deg)), w2 = 1 - kEccentricity2 * s * s;
  const double meridian_m = kSemiMajorM * (1 - kEccentricity2) / (w2 * std::sqrt(w2));
  const double parallel_m = kSemiMajorM / std::sqrt(w2) * std::cos(radians_from_degrees(latitude_deg));
  for (InventoryTree& tree : trees) {
    tree.x_m = radians_from_degrees(tree.x_m - longitude_deg) * parallel_m;
    tree.y_m = radians_from_degrees(tree.y_m - latitude_deg) * meridian_m;
  }
  char text[120];
  std::snprintf(text, sizeof text, "places are metres east and north of %.6f degrees east, %.6f north",
                first_deg + longitude_deg, latitude_deg);
  return text;
}

}  // namespace sunfleck
