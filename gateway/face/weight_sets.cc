#include "gateway/face/weight_sets.h"

#include <algorithm>
#include <stdexcept>

#include "embedded/gateway_arkit52.h"
#include "embedded/gateway_visemes.h"
#include "vdm/net/sound_classes.h"
#include "vdm/net/word_lines.h"

namespace gateway {

std::vector<float> WeightSet::Of(const vdm::MouthFrame& frame) const {
  std::vector<float> weights(names_.size());
  for (std::size_t sound = 0; sound < of_sound_.size(); ++sound) {
    weights[of_sound_[sound]] += frame.sounds[sound];
  }
  if (visemes()) return weights;
  return sums_.Of(MouthNumbers(frame.mouth, frame.seal, frame.tongue));
}

vm::Result<WeightSets> WeightSets::Read(std::string_view visemes, std::string_view arkit) {
  WeightSets sets;
  if (auto read = sets.ReadVisemes(visemes); !read) return std::unexpected(read.error());
  if (auto read = sets.ReadBlendShapes(arkit); !read) return std::unexpected(read.error());
  return sets;
}

vm::Result<void> WeightSets::ReadVisemes(std::string_view text) {
  const auto& sounds = vdm::SoundClasses::Built().names();
  constexpr std::size_t kUnset = static_cast<std::size_t>(-1);
  vdm::WordLines lines("visemes.txt", text);
  for (auto words = lines.Next(); !words.empty(); words = lines.Next()) {
    if (words[0] == "set") {
      if (words.size() < 3) return lines.Wrong("expected set NAME VISEME...");
      WeightSet set;
      set.name_ = words[1];
      set.names_.assign(words.begin() + 2, words.end());
      set.of_sound_.assign(sounds.size(), kUnset);
      sets_.push_back(std::move(set));
      continue;
    }
    const auto sound = std::ranges::find(sounds, words[0]);
    if (sound == sounds.end()) {
      return lines.Wrong("'" + std::string(words[0]) + "' is no class of sounds");
    }
    if (words.size() != sets_.size() + 1) return lines.Wrong("expected a viseme for each set");
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      const auto viseme = std::ranges::find(sets_[i].names_, words[i + 1]);
      if (viseme == sets_[i].names_.end()) {
        return lines.Wrong("'" + std::string(words[i + 1]) + "' is not in " + sets_[i].name_);
      }
      sets_[i].of_sound_[static_cast<std::size_t>(sound - sounds.begin())] =
          static_cast<std::size_t>(viseme - sets_[i].names_.begin());
    }
  }
  for (const WeightSet& set : sets_) {
    const auto unset = std::ranges::find(set.of_sound_, kUnset);
    if (unset == set.of_sound_.end()) continue;
    return lines.Wrong("no row for '" +
                       sounds[static_cast<std::size_t>(unset - set.of_sound_.begin())] + "'");
  }
  return {};
}

vm::Result<void> WeightSets::ReadBlendShapes(std::string_view text) {
  auto sums = WeightSums::Read("arkit52.txt", text, MouthNumberOf);
  if (!sums) return std::unexpected(sums.error());
  WeightSet set;
  set.name_ = "arkit52";
  set.names_ = sums->names;
  set.sums_ = std::move(*sums);
  sets_.push_back(std::move(set));
  return {};
}

const WeightSets& WeightSets::Built() {
  static const WeightSets built = [] {
    auto read = Read(embedded::gateway_visemes(), embedded::gateway_arkit52());
    if (!read) throw std::runtime_error(read.error().text);
    return std::move(*read);
  }();
  return built;
}

vm::Result<const WeightSet*> WeightSets::Find(std::string_view name) const {
  std::string known;
  for (const WeightSet& set : sets_) {
    if (set.name() == name) return &set;
    known += (known.empty() ? "" : ", ") + set.name();
  }
  return vm::Fail(vm::Errc::kBadValue,
                  "there is no set '" + std::string(name.substr(0, 40)) + "', expected " + known);
}

}  // namespace gateway
