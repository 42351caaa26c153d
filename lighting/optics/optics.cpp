#include "lighting/optics/optics.h"

#include <algorithm>
#include <set>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

bool in_unit_range(double x) { return x >= 0.0 && x <= 1.0; }

void check_optics(const MaterialOptics& optics, const std::string& where) {
  const LeafOptics& leaf = optics.leaf;
  for (const double x : {leaf.reflectance_front, leaf.reflectance_back, leaf.transmittance_front,
                         leaf.transmittance_back, optics.bark_reflectance})
    if (!in_unit_range(x))
      throw_invalid(where, "reflectance or transmittance outside [0, 1]", "numbers between 0 and 1");
  if (leaf.albedo_front() > 1.0 + 1e-12 || leaf.albedo_back() > 1.0 + 1e-12)
    throw_invalid(where, "leaf reflectance + transmittance is over 1", "r + t <= 1 on each face");
}

MaterialOptics stored_optics(const Material& material, const std::string& band) {
  std::string known;
  for (const MaterialBand& b : material.bands) {
    if (b.band == band)
      return {{b.leaf_reflectance, b.leaf_reflectance, b.leaf_transmittance, b.leaf_transmittance},
              b.bark_reflectance};
    known += (known.empty() ? "" : ", ") + b.band;
  }
  throw_invalid("bands." + band, "material '" + material.name + "' has no numbers for this band",
                (known.empty() ? "" : "one of " + known + ", or ") +
                    "give its leaf_reflectance and leaf_transmittance in [[light.optics]]");
}

MaterialOptics find_optics(const Material& material, const std::string& band,
                           const std::vector<OpticsOverride>& overrides) {
  for (const bool general : {false, true})
    for (const OpticsOverride& o : overrides)
      if (o.band == band && o.material == (general ? "*" : material.name)) return o.optics;
  return stored_optics(material, band);
}

void check_override(const Forest& forest, const OpticsRequest& request, const OpticsOverride& o) {
  if (std::find(request.bands.begin(), request.bands.end(), o.band) == request.bands.end())
    throw_invalid("optics." + o.band, "no band of that name is asked for", "one of the request's bands");
  std::string known;
  for (const Material& m : forest.materials) {
    if (o.material == "*" || o.material == m.name) return;
    known += ", " + m.name;
  }
  throw_invalid("optics." + o.material, "the forest has no material of that name", "one of *" + known);
}

const Material& find_material(const Forest& forest, const std::string& name) {
  const auto found = std::find_if(forest.materials.begin(), forest.materials.end(),
                                  [&](const Material& m) { return m.name == name; });
  if (found == forest.materials.end())
    throw_invalid("materials." + name, "is not among the forest's materials", "add it");
  return *found;
}

void check_request(const OpticsRequest& request) {
  if (request.bands.empty()) throw_invalid("bands", "no band asked for", "at least one, for example PAR");
  std::set<std::string> seen;
  for (const std::string& band : request.bands)
    if (!seen.insert(band).second) throw_invalid("bands." + band, "is asked for twice", "every band once");
  if (request.soil_albedo.size() != request.bands.size())
    throw_invalid("soil_albedo", "has " + std::to_string(request.soil_albedo.size()) + " values",
                  "one for each of the " + std::to_string(request.bands.size()) + " bands");
  for (std::size_t b = 0; b < request.bands.size(); ++b)
    if (!in_unit_range(request.soil_albedo[b]))
      throw_invalid("bands." + request.bands[b] + ".soil_albedo", "is outside [0, 1]",
                    "a number between 0 and 1");
}

}  // namespace

OpticsTable::OpticsTable(const Forest& forest, const OpticsRequest& request)
    : bands_(request.bands), soil_albedo_(request.soil_albedo) {
  check_request(request);
  for (const OpticsOverride& o : request.overrides) check_override(forest, request, o);
  std::size_t rows = 0;
  for (const Prototype& p : forest.prototypes) {
    first_.push_back(rows);
    rows += p.materials.size();
  }
  for (const std::string& band : bands_) {
    std::vector<MaterialOptics>& column = table_.emplace_back();
    for (const Prototype& p : forest.prototypes)
      for (const std::string& name : p.materials) {
        column.push_back(find_optics(find_material(forest, name), band, request.overrides));
        check_optics(column.back(), "bands." + band + "." + name);
      }
  }
}

}  // namespace sunfleck
