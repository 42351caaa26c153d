#include "lighting/links/link_row.h"

#include "lighting/links/link_ends.h"

namespace sunfleck::links {

void store_ends(const trace::Receivers& receivers, std::span<std::uint32_t> ends, std::size_t lobe,
                std::size_t more_sky_rays, InstanceEnds& out) {
  const auto skies = std::stable_partition(ends.begin(), ends.end(), [](auto end) { return !is_sky(end); });
  const auto dark =
      std::stable_partition(ends.begin(), skies, [&](auto end) { return end < receivers.sky(); });
  out.faces_met[lobe] = static_cast<std::uint16_t>(dark - ends.begin());
  out.not_sky[lobe] = static_cast<std::uint16_t>(skies - ends.begin());
  out.sky_rays[lobe] =
      static_cast<std::uint16_t>(static_cast<std::size_t>(ends.end() - skies) + more_sky_rays);
}

void make_room(InstanceEnds& out, std::size_t lobes, std::size_t ends) {
  out.ends.resize(ends);
  out.faces_met.resize(lobes);
  out.not_sky.resize(lobes);
  out.sky_rays.resize(lobes);
}

}  // namespace sunfleck::links
