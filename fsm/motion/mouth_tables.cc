#include "fsm/motion/mouth_tables.h"

#include <fmt/format.h>

#include "fsm/motion/table_text.h"
#include "fsm/motion/track.h"

namespace fsm {

MouthPose Mix(const MouthPose& a, const MouthPose& b, double share_of_b) {
  return {Mix(a.mouth, b.mouth, share_of_b), Mix(a.seal, b.seal, share_of_b),
          Mix(a.tongue, b.tongue, share_of_b)};
}

vm::Result<MouthShapes> ReadMouthShapes(const std::string& name, std::string_view text) {
  const TableText table(name, text);
  MouthShapes shapes;
  constexpr std::size_t kWords = 1 + kMouthParameters + 3;
  for (const TableLine& line : table.lines()) {
    if (line.words.size() != kWords) {
      return table.Wrong(line.number,
                         fmt::format("{} words found; a name, 17 mouth parameters, seal, tongue "
                                     "and hold expected",
                                     line.words.size()));
    }
    MouthShape shape;
    shape.name = line.words[0];
    for (std::size_t i = 0; i < kMouthParameters; ++i) {
      const auto value =
          table.Number(line, 1 + i, fmt::format("mouth parameter {}", i + 1), -60, 60);
      if (!value) return std::unexpected(value.error());
      shape.pose.mouth[i] = static_cast<float>(*value);
    }
    const auto seal = table.Number(line, 18, "seal", 0, 1);
    if (!seal) return std::unexpected(seal.error());
    const auto tongue = table.Number(line, 19, "tongue", 0, 1);
    if (!tongue) return std::unexpected(tongue.error());
    const auto hold = table.Number(line, 20, "hold", 0, 0.9);
    if (!hold) return std::unexpected(hold.error());
    shape.pose.seal = static_cast<float>(*seal);
    shape.pose.tongue = static_cast<float>(*tongue);
    shape.hold = *hold;
    for (const MouthShape& earlier : shapes) {
      if (earlier.name == shape.name) {
        return table.Wrong(line.number, "there is a shape '" + shape.name + "' already");
      }
    }
    shapes.push_back(std::move(shape));
  }
  if (shapes.size() != kMouthShapes) {
    return table.Wrong(0, fmt::format("{} shapes found, {} expected", shapes.size(), kMouthShapes));
  }
  return shapes;
}

vm::Result<PhonemeTable> ReadPhonemeTable(const std::string& name, std::string_view text,
                                          const MouthShapes& shapes) {
  const TableText table(name, text);
  PhonemeTable phonemes;
  for (const TableLine& line : table.lines()) {
    if (line.words.size() != 3 && line.words.size() != 5) {
      return table.Wrong(line.number,
                         "a phoneme, then one or two pairs of shape and strength expected");
    }
    PhonemeLook look;
    for (std::size_t i = 1; i < line.words.size(); i += 2) {
      PhonemeLook::Part part{PhonemeLook::kNext - 1, 1};
      if (line.words[i] == "next") part.shape = PhonemeLook::kNext;
      for (std::size_t k = 0; k < shapes.size(); ++k) {
        if (shapes[k].name == line.words[i]) part.shape = static_cast<int>(k);
      }
      if (part.shape < PhonemeLook::kNext) {
        return table.Wrong(line.number,
                           fmt::format("'{}' is neither a mouth shape nor 'next'", line.words[i]));
      }
      const auto strength = table.Number(line, i + 1, "a strength", 0, 2);
      if (!strength) return std::unexpected(strength.error());
      part.strength = *strength;
      look.parts.push_back(part);
    }
    if (!phonemes.emplace(line.words[0], std::move(look)).second) {
      return table.Wrong(line.number, "the phoneme '" + line.words[0] + "' is here twice");
    }
  }
  if (phonemes.empty()) return table.Wrong(0, "no phoneme found");
  return phonemes;
}

}  // namespace fsm
