// Compares two pictures of `sunfleck render --exr`: lighting_render_compare a.exr b.exr. Prints bias and mean
// absolute difference of all and of what each pixel's centre shows (leaves or wood, ground, sky), per
// channel.
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "lighting/render/image_difference.h"

namespace {

sunfleck::Image load(const char* path) {
  const auto input = OIIO::ImageInput::open(path);
  if (!input) std::fprintf(stderr, "%s: %s\n", path, OIIO::geterror().c_str()), std::exit(1);
  const OIIO::ImageSpec spec = input->spec();
  const auto n = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  std::vector<float> all(n * static_cast<std::size_t>(spec.nchannels));
  input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, all.data());
  sunfleck::Image image;
  image.width_px = spec.width, image.height_px = spec.height;
  for (std::size_t p = 0; p < n; ++p) {
    const auto value = [&](const char* name) {
      return all[p * static_cast<std::size_t>(spec.nchannels) +
                 static_cast<std::size_t>(spec.channelindex(name))];
    };
    image.rgb.insert(image.rgb.end(), {value("R"), value("G"), value("B")});
    image.depth_m.push_back(value("depth.Z"));
    image.instance_id.push_back(value("instance.id"));
    image.irradiance_w_m2.push_back(value("irradiance.Y"));
    image.rgb_standard_error.push_back(value("error.Y"));
  }
  return image;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const sunfleck::Image a = load(argv[1]), b = load(argv[2]);
  const auto d = sunfleck::image_difference(a, b);
  std::printf("bias %+.2f %%, mean absolute difference %.2f %%, SSIM %.4f, FLIP %.4f, noise %.2f / %.2f %%\n",
              100 * d.bias, 100 * d.mean_absolute, d.ssim, d.flip, 100 * sunfleck::image_noise(a),
              100 * sunfleck::image_noise(b));
  const char* names[] = {"leaves", "wood", "ground", "sky"};
  double sum_a[4][3] = {}, sum_b[4][3] = {}, apart[4] = {}, count[4] = {};
  for (std::size_t p = 0; p < a.depth_m.size(); ++p) {
    const int kind = std::isinf(b.depth_m[p])     ? 3
                     : b.instance_id[p] < 0.0f    ? 2
                     : a.irradiance_w_m2[p] > 0.f ? 0
                                                  : 1;
    ++count[kind];
    for (std::size_t c = 0; c < 3; ++c) {
      sum_a[kind][c] += a.rgb[3 * p + c], sum_b[kind][c] += b.rgb[3 * p + c];
      apart[kind] += std::abs(static_cast<double>(a.rgb[3 * p + c]) - b.rgb[3 * p + c]);
    }
  }
  for (int k = 0; k < 4; ++k) {
    const double all = sum_b[k][0] + sum_b[k][1] + sum_b[k][2];
    if (count[k] == 0 || all == 0) continue;
    std::printf("%-7s %5.1f %% of pixels: red %+.2f, green %+.2f, blue %+.2f, absolute %.2f %%\n", names[k],
                100 * count[k] / static_cast<double>(a.depth_m.size()), 100 * (sum_a[k][0] / sum_b[k][0] - 1),
                100 * (sum_a[k][1] / sum_b[k][1] - 1), 100 * (sum_a[k][2] / sum_b[k][2] - 1),
                100 * apart[k] / all);
  }
}
