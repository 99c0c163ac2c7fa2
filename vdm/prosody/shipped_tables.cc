#include <stdexcept>

#include "embedded/head_net.h"
#include "embedded/head_prosody_net.h"
#include "embedded/voice_emotions.h"
#include "vdm/prosody/emotion_reader.h"
#include "vdm/prosody/head_net.h"

namespace vdm {
namespace {

template <typename T>
T OrThrow(vm::Result<T> read) {
  if (!read) throw std::runtime_error(read.error().text);
  return std::move(*read);
}

}  // namespace

const HeadNet& ShippedHeadNet(bool by_prosody_alone) {
  static const HeadNet all = OrThrow(ParseHeadNet("head.net", embedded::head_net()));
  static const HeadNet alone =
      OrThrow(ParseHeadNet("head_prosody.net", embedded::head_prosody_net()));
  return by_prosody_alone ? alone : all;
}

const Discriminant& ShippedEmotions() {
  static const Discriminant functions = [] {
    Discriminant read = OrThrow(ParseDiscriminant("emotions.txt", embedded::voice_emotions()));
    if (read.features != PhraseMeter::FeatureNames()) {
      throw std::runtime_error("emotions.txt: has other features than phrases are measured by");
    }
    return read;
  }();
  return functions;
}

}  // namespace vdm
