// Light of the elements of a light map file: band by band and field by field in blocks of one chunk, so that
// memory stays that of the map.
#include <algorithm>
#include <cmath>

#include "lighting/map/netcdf_sink.h"
#include "sim/base/contract.h"

namespace sunfleck::netcdf {
namespace {

struct LightVariables {
  std::vector<int> fields;
  int sunlit = 0;
  int standard_error = -1;  // -1: no band has one
};

bool any_standard_error(const LightMap& map) {
  return std::any_of(map.bands.begin(), map.bands.end(),
                     [](const BandLightMap& band) { return !band.standard_error_w_m2.empty(); });
}

LightVariables define_light(const Sink& sink, const LightMap& map) {
  const std::vector<int> at{sink.dimensions.band, sink.dimensions.element};
  LightVariables v;
  v.sunlit = define(sink, "sunlit_fraction", NC_FLOAT, {sink.dimensions.element},
                    {"1", "share of the element's area that the centre of the sun sees", kElementPlace});
  for (const ElementField& field : kElementFields)
    v.fields.push_back(
        define(sink, field.name, NC_FLOAT, at, {field.units, field.long_name, kElementBandPlace}));
  if (!any_standard_error(map)) return v;
  v.standard_error =
      define(sink, "irradiance_standard_error", NC_FLOAT, at,
             {"W m-2", "standard error of the total of front and back irradiance", kElementBandPlace});
  const float missing = NC_FILL_FLOAT;
  sink.file.check(nc_put_att_float(sink.file.id(), v.standard_error, "_FillValue", NC_FLOAT, 1, &missing),
                  "_FillValue");
  return v;
}

// One field of one band, block by block.
template <class ValueAt>
void write_blocks(const Sink& sink, int variable, std::vector<std::size_t> start, const ValueAt& value_at) {
  std::vector<float> block;
  for (std::size_t begin = 0; begin < sink.dimensions.elements; begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, sink.dimensions.elements);
    block.clear();
    for (std::size_t i = begin; i < end; ++i) {
      block.push_back(value_at(i));
      SUNFLECK_EXPECTS(std::isfinite(block.back()));
    }
    start.back() = begin;
    std::vector<std::size_t> count(start.size(), 1);
    count.back() = end - begin;
    put(sink, variable, start, count, block);
  }
}

}  // namespace

void write_light(const Sink& sink, const LightMap& map) {
  const LightVariables v = define_light(sink, map);
  write_blocks(sink, v.sunlit, {0}, [&](std::size_t i) { return map.sunlit_fraction[i]; });
  for (std::size_t b = 0; b < map.bands.size(); ++b) {
    const BandLightMap& band = map.bands[b];
    for (std::size_t f = 0; f < kElementFields.size(); ++f)
      write_blocks(sink, v.fields[f], {b, 0}, [&](std::size_t i) {
        ElementLight element = band.elements[i];
        return kElementFields[f].of(element);
      });
    if (!band.standard_error_w_m2.empty())
      write_blocks(sink, v.standard_error, {b, 0},
                   [&](std::size_t i) { return band.standard_error_w_m2[i]; });
  }
}

}  // namespace sunfleck::netcdf
