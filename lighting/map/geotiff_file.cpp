#include "lighting/map/geotiff_file.h"

#include <bit>
#include <cstring>

#include "sim/base/error.h"
#include "sim/base/pending_file.h"

namespace sunfleck {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::uint16_t kAscii = 2, kShort = 3, kLong = 4, kDouble = 12;

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

// The fields of the one image in the file; they must be added in rising order of their tags.
class Directory {
 public:
  void shorts(std::uint16_t tag, std::vector<std::uint16_t> v) { add(tag, kShort, v.size(), bytes_of(v)); }
  void longs(std::uint16_t tag, std::vector<std::uint32_t> v) { add(tag, kLong, v.size(), bytes_of(v)); }
  void doubles(std::uint16_t tag, std::vector<double> v) { add(tag, kDouble, v.size(), bytes_of(v)); }
  void text(std::uint16_t tag, const std::string& v) { add(tag, kAscii, v.size() + 1, v + '\0'); }

  // The directory at `offset` and what does not fit into it behind it.
  std::string bytes(std::uint32_t offset) const {
    std::string table, behind;
    const auto put = [&](auto value) { table.append(reinterpret_cast<const char*>(&value), sizeof value); };
    const auto count = static_cast<std::uint16_t>(fields_.size());
    const std::uint32_t end = offset + 2u + 12u * count + 4u;
    put(count);
    for (const Field& f : fields_) {
      put(f.tag);
      put(f.type);
      put(f.count);
      if (f.bytes.size() <= 4) {
        table += f.bytes + std::string(4 - f.bytes.size(), '\0');
        continue;
      }
      put(static_cast<std::uint32_t>(end + behind.size()));
      behind += f.bytes;
      if (behind.size() % 2 == 1) behind += '\0';
    }
    put(std::uint32_t{0});  // no further image
    return table + behind;
  }

 private:
  struct Field {
    std::uint16_t tag, type;
    std::uint32_t count;
    std::string bytes;
  };
  void add(std::uint16_t tag, std::uint16_t type, std::size_t count, std::string bytes) {
    fields_.push_back({tag, type, static_cast<std::uint32_t>(count), std::move(bytes)});
  }
  std::vector<Field> fields_;
};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

// What GDAL shows of each band. It takes the mark-up off twice: once as XML, once as its own.
std::string gdal_metadata(const GeoRaster& raster) {
  std::string xml = "<GDALMetadata>\n";
  const auto item = [&](const char* name, std::size_t band, const char* role, const std::string& value) {
    xml += "  <Item name=\"" + std::string(name) + "\" sample=\"" + std::to_string(band) + "\"" + role + ">" +
           escaped(escaped(value)) + "</Item>\n";
  };
  for (std::size_t b = 0; b < raster.bands.size(); ++b) {
    item("DESCRIPTION", b, " role=\"description\"", raster.bands[b].name);
    item("UNITTYPE", b, " role=\"unittype\"", raster.bands[b].units);
    item("long_name", b, "", raster.bands[b].description);
  }
  return xml + "</GDALMetadata>\n";
}

// GeoTIFF 1.1, 7.2: a projected system by its number, or one of its own whose name says what it is; cells are
// areas; metres.
void add_place(const GeoRaster& raster, Directory& tags) {
  constexpr std::uint16_t kModelType = 1024, kRasterType = 1025, kCitation = 1026, kProjected = 3072,
                          kLinearUnits = 3076, kUserDefined = 32767, kMetre = 9001, kAsciiParams = 34737;
  const std::string name = raster.epsg > 0 ? "EPSG:" + std::to_string(raster.epsg) + "|"
                                           : "Local plane coordinates of the stand, metres, x east, y north|";
  const auto number = raster.epsg > 0 ? static_cast<std::uint16_t>(raster.epsg) : kUserDefined;
  tags.doubles(33550, {raster.cell_m.x, raster.cell_m.y, 0});
  tags.doubles(33922, {0, 0, 0, raster.north_west_m.x, raster.north_west_m.y, 0});
  tags.shorts(34735, {1,
                      1,
                      1,
                      5,  //
                      kModelType,
                      0,
                      1,
                      1,  // projected
                      kRasterType,
                      0,
                      1,
                      1,  // area
                      kCitation,
                      kAsciiParams,
                      static_cast<std::uint16_t>(name.size()),
                      0,  //
                      kProjected,
                      0,
                      1,
                      number,  //
                      kLinearUnits,
                      0,
                      1,
                      kMetre});
  tags.text(34737, name);
}

Directory directory_of(const GeoRaster& raster, const std::vector<std::uint32_t>& strips) {
  const std::size_t n = raster.bands.size();
  const auto strip_bytes = static_cast<std::uint32_t>(4ull * raster.columns * raster.rows);
  const auto all = [&](std::uint16_t value) { return std::vector<std::uint16_t>(n, value); };
  Directory tags;
  tags.longs(256, {raster.columns});
  tags.longs(257, {raster.rows});
  tags.shorts(258, all(32));
  tags.shorts(259, {1});  // not compressed
  tags.shorts(262, {1});  // low values are dark
  tags.longs(273, strips);
  tags.shorts(277, {static_cast<std::uint16_t>(n)});
  tags.longs(278, {raster.rows});
  tags.longs(279, std::vector<std::uint32_t>(n, strip_bytes));
  tags.shorts(284, {2});  // band after band
  if (n > 1) tags.shorts(338, std::vector<std::uint16_t>(n - 1, 0));
  tags.shorts(339, all(3));  // floats
  add_place(raster, tags);
  tags.text(42112, gdal_metadata(raster));
  tags.text(42113, "nan");
  return tags;
}

void check(const GeoRaster& raster, const std::filesystem::path& path) {
  if (path.extension() != ".tif" && path.extension() != ".tiff")
    throw_invalid(path.string(), "a GeoTIFF does not end in '" + path.extension().string() + "'", ".tif");
  const std::uint64_t cells = std::uint64_t{raster.columns} * raster.rows;
  if (cells == 0 || raster.bands.empty())
    throw_invalid(path.string(), "has no cells or no bands", "at least one");
  if (raster.epsg < 0 || raster.epsg > 32766)
    throw_invalid("epsg", std::to_string(raster.epsg) + " is no projected system", "1024 to 32766, or 0");
  for (const GeoTiffBand& band : raster.bands)
    if (band.value.size() != cells)
      throw_invalid(
          "band " + band.name,
          "has " + std::to_string(band.value.size()) + " values for " + std::to_string(cells) + " cells",
          "one for every cell");
  constexpr std::uint64_t kMostBytes = 4'000'000'000, kMostBands = 65535;
  if (raster.bands.size() > kMostBands || 4 * cells * raster.bands.size() > kMostBytes)
    throw Error(ErrorKind::kLimitExceeded, path.string(),
                std::to_string(raster.bands.size()) + " bands of " + std::to_string(cells) +
                    " cells do not fit into a TIFF file of 4 GiB",
                "larger cells or fewer intervals");
}

}  // namespace

void save_geotiff(const GeoRaster& raster, const std::filesystem::path& path) {
  check(raster, path);
  constexpr std::uint32_t kHeader = 8;
  // Its size does not depend on where the strips lie.
  const std::string sized =
      directory_of(raster, std::vector<std::uint32_t>(raster.bands.size())).bytes(kHeader);
  const std::uint32_t first = kHeader + static_cast<std::uint32_t>((sized.size() + 3) / 4 * 4);
  std::vector<std::uint32_t> strips;
  for (std::size_t b = 0; b < raster.bands.size(); ++b)
    strips.push_back(first + static_cast<std::uint32_t>(4ull * b * raster.columns * raster.rows));
  std::string file = std::string("II*\0", 4) + bytes_of(std::vector<std::uint32_t>{kHeader});
  file += directory_of(raster, strips).bytes(kHeader);
  file.resize(first, '\0');
  for (const GeoTiffBand& band : raster.bands) file += bytes_of(band.value);
  write_whole_file(path, file);
}

}  // namespace sunfleck
