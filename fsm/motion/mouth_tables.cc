#include "fsm/motion/mouth_tables.h"

#include <fmt/format.h>

#include <algorithm>

#include "fsm/motion/table_text.h"
#include "fsm/motion/track.h"

namespace fsm {
namespace {

constexpr std::size_t kShapeValues = kMouthParameters + 3;

}  // namespace

MouthPose Mix(const MouthPose& a, const MouthPose& b, double share_of_b) {
  return {Mix(a.mouth, b.mouth, share_of_b), Mix(a.seal, b.seal, share_of_b),
          Mix(a.tongue, b.tongue, share_of_b), Mix(a.contact, b.contact, share_of_b)};
}

vm::Result<void> ReadShapeValues(const std::vector<std::string>& words, std::size_t first,
                                 Viseme& shape) {
  const std::size_t count = words.size() - std::min(first, words.size());
  if (count < kMouthParameters || count > kShapeValues) {
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("{} numbers found; 17 mouth parameters, and up to three more for "
                                "seal, tongue and hold, expected",
                                count));
  }
  Viseme out = shape;
  for (std::size_t i = 0; i < count; ++i) {
    const bool parameter = i < kMouthParameters;
    const std::string what = parameter ? fmt::format("mouth parameter {}", i + 1)
                                       : std::array{"seal", "tongue", "hold"}[i - kMouthParameters];
    const double lowest = parameter ? -60 : 0;
    const double highest = parameter ? 60 : i + 1 == kShapeValues ? 0.9 : 1;
    const auto value = ParseNumber(words[first + i]);
    if (!value || *value < lowest || *value > highest) {
      return vm::Fail(vm::Errc::kBadValue,
                      fmt::format("'{}' found, {} expected, a number from {:g} to {:g}",
                                  words[first + i], what, lowest, highest));
    }
    if (parameter) out.pose.mouth[i] = static_cast<float>(*value);
    if (i == kMouthParameters) out.pose.seal = static_cast<float>(*value);
    if (i == kMouthParameters + 1) out.pose.tongue = static_cast<float>(*value);
    if (i == kMouthParameters + 2) out.hold = *value;
  }
  shape = std::move(out);
  return {};
}

std::string FormatShapeValues(const Viseme& shape) {
  std::string text;
  for (const float value : shape.pose.mouth) text += fmt::format("{:g} ", value);
  return text + fmt::format("{:g} {:g} {:g}", shape.pose.seal, shape.pose.tongue, shape.hold);
}

const Viseme* FindShape(const Visemes& shapes, std::string_view name) {
  const auto found = std::ranges::find(shapes, name, &Viseme::name);
  return found == shapes.end() ? nullptr : &*found;
}

vm::Result<Visemes> ReadVisemes(const std::string& name, std::string_view text, std::size_t count) {
  const TableText table(name, text);
  Visemes shapes;
  for (const TableLine& line : table.lines()) {
    if (line.words.size() != 1 + kShapeValues) {
      return table.Wrong(line.number,
                         fmt::format("{} words found; a name, 17 mouth parameters, seal, tongue "
                                     "and hold expected",
                                     line.words.size()));
    }
    Viseme shape;
    shape.name = line.words[0];
    if (auto read = ReadShapeValues(line.words, 1, shape); !read) {
      return table.Wrong(line.number, read.error().text);
    }
    if (FindShape(shapes, shape.name) != nullptr) {
      return table.Wrong(line.number, "there is a shape '" + shape.name + "' already");
    }
    shapes.push_back(std::move(shape));
  }
  if (shapes.size() != count) {
    return table.Wrong(0, fmt::format("{} shapes found, {} expected", shapes.size(), count));
  }
  if (FindShape(shapes, "rest") == nullptr) {
    return table.Wrong(0, "no shape 'rest', which is the mouth of pauses");
  }
  return shapes;
}

vm::Result<PhonemeTable> ReadPhonemeTable(const std::string& name, std::string_view text,
                                          const Visemes& shapes) {
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

namespace {

vm::Result<void> ReadDominanceRow(const TableText& table, const TableLine& line, Viseme& shape) {
  const std::string& kind = line.words[3];
  if (kind != "vowel" && kind != "consonant" && kind != "pause") {
    return table.Wrong(line.number, "'" + kind + "' found; vowel, consonant or pause expected");
  }
  Dominance& d = shape.dominance;
  d.vowel = kind == "vowel";
  std::array<double, 6> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool early = i == 4;
    const auto value = table.Number(line, 4 + i,
                                    early    ? "ms of anticipation"
                                    : i == 5 ? "a contact"
                                             : "a dominance",
                                    0, early ? 500 : 1);
    if (!value) return std::unexpected(value.error());
    values[i] = *value;
  }
  d.jaw = values[0];
  d.lips = values[1];
  d.round = values[2];
  d.tongue = values[3];
  d.early_ms = std::max(1.0, values[4]);
  shape.pose.contact = static_cast<float>(values[5]);
  return {};
}

}  // namespace

vm::Result<Reach> ReadDominance(const std::string& name, std::string_view text, Visemes& set14,
                                Visemes& set28) {
  const TableText table(name, text);
  Reach reach;
  std::vector<const Viseme*> done;
  for (const TableLine& line : table.lines()) {
    if (line.words[0] == "reach") {
      for (const std::size_t i : {1u, 2u}) {
        const auto ms = table.Number(line, i, "a reach in ms", 1, 500);
        if (!ms) return std::unexpected(ms.error());
        (i == 1 ? reach.before_ms : reach.after_ms) = *ms;
      }
      continue;
    }
    if (line.words[0] != "shape" || line.words.size() != 10) {
      return table.Wrong(line.number,
                         "reach BEFORE AFTER, or shape SET NAME KIND JAW LIPS ROUND TONGUE EARLY "
                         "CONTACT expected");
    }
    if (line.words[1] != "14" && line.words[1] != "28") {
      return table.Wrong(line.number, "'" + line.words[1] + "' found; set 14 or 28 expected");
    }
    Visemes& set = line.words[1] == "14" ? set14 : set28;
    const auto shape = std::ranges::find(set, line.words[2], &Viseme::name);
    if (shape == set.end()) {
      return table.Wrong(line.number,
                         "there is no mouth shape '" + line.words[2] + "' in set " + line.words[1]);
    }
    if (auto read = ReadDominanceRow(table, line, *shape); !read) {
      return std::unexpected(read.error());
    }
    done.push_back(&*shape);
  }
  for (const Visemes* set : {&set14, &set28}) {
    for (const Viseme& shape : *set) {
      if (std::ranges::find(done, &shape) == done.end()) {
        return table.Wrong(0, "no row for the mouth shape '" + shape.name + "'");
      }
    }
  }
  return reach;
}

}  // namespace fsm
