// Networks of vdm as text, and its tables: no input may do more than be refused.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "vdm/net/mouth_net.h"
#include "vdm/net/sound_classes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  static_cast<void>(vdm::SoundClasses::Read("sounds.txt", text));
  const auto net = vdm::ParseMouthNet("x.net", text);
  if (!net) return 0;
  const std::string written = vdm::FormatMouthNet(*net);
  const auto again = vdm::ParseMouthNet("x.net", written);
  if (!again || vdm::FormatMouthNet(*again) != written) std::abort();
  return 0;
}
