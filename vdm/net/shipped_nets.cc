#include <stdexcept>

#include "embedded/cepstra_net.h"
#include "embedded/mel_net.h"
#include "embedded/phones_net.h"
#include "embedded/words_net.h"
#include "vdm/net/mouth_net.h"

namespace vdm {
namespace {

MouthNet ReadShipped(const std::string& name, std::string_view text) {
  auto read = ParseMouthNet(name, text);
  if (!read) throw std::runtime_error(read.error().text);
  return std::move(*read);
}

}  // namespace

const MouthNet& ShippedNet(FeatureKind features) {
  switch (features) {
    case FeatureKind::kMel: {
      static const MouthNet mel = ReadShipped("mel.net", embedded::mel_net());
      return mel;
    }
    case FeatureKind::kPhones: {
      static const MouthNet phones = ReadShipped("phones.net", embedded::phones_net());
      return phones;
    }
    case FeatureKind::kWords: {
      static const MouthNet words = ReadShipped("words.net", embedded::words_net());
      return words;
    }
    case FeatureKind::kCepstra:
      break;
  }
  static const MouthNet cepstra = ReadShipped("cepstra.net", embedded::cepstra_net());
  return cepstra;
}

}  // namespace vdm
