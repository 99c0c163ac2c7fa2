#include "fsm/motion/inputs/viseme_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "fsm/base/parse_number.h"
#include "fsm/base/table_reader.h"
#include "fsm/motion/base/track.h"

namespace fsm {
namespace {

constexpr std::size_t kShapeValues = kMouthParameters + 3;

/// The name and the bounds of a value in a row.
struct ShapeValue {
  std::string what;
  double min, max;
};
ShapeValue ValueAt(std::size_t index) {
  switch (index) {
    case kMouthParameters:
      return {"seal", 0, 1};
    case kMouthParameters + 1:
      return {"tongue", 0, 1};
    case kMouthParameters + 2:
      return {"hold", 0, 0.9};
    default:
      return {fmt::format("mouth parameter {}", index + 1), -60, 60};
  }
}

}  // namespace

MouthPose Mix(const MouthPose& a, const MouthPose& b, double share_of_b) {
  return {Mix(a.mouth, b.mouth, share_of_b), Mix(a.seal, b.seal, share_of_b),
          Mix(a.tongue, b.tongue, share_of_b), Mix(a.contact, b.contact, share_of_b)};
}

FaceState StateOf(const Viseme& viseme) {
  FaceState state;
  state.mouth = viseme.pose.mouth;
  state.seal = viseme.pose.seal;
  state.tongue = viseme.pose.tongue;
  return state;
}

vm::Result<void> ReadVisemeValues(const std::vector<std::string>& words, std::size_t first,
                                  Viseme& viseme) {
  const std::size_t count = words.size() - std::min(first, words.size());
  if (count < kMouthParameters || count > kShapeValues) {
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("{} numbers found; {} mouth parameters, and up to three more for "
                                "seal, tongue and hold, expected",
                                count, kMouthParameters));
  }
  Viseme out = viseme;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [what, min, max] = ValueAt(i);
    const auto value = ParseNumber(words[first + i]);
    if (!value || *value < min || *value > max) {
      return vm::Fail(vm::Errc::kBadValue,
                      fmt::format("'{}' found, {} expected, a number from {:g} to {:g}",
                                  words[first + i], what, min, max));
    }
    if (i < kMouthParameters) out.pose.mouth[i] = static_cast<float>(*value);
    if (i == kMouthParameters) out.pose.seal = static_cast<float>(*value);
    if (i == kMouthParameters + 1) out.pose.tongue = static_cast<float>(*value);
    if (i == kMouthParameters + 2) out.hold = *value;
  }
  viseme = std::move(out);
  return {};
}

std::string FormatVisemeValues(const Viseme& viseme) {
  std::string text;
  for (const float value : viseme.pose.mouth) text += fmt::format("{:g} ", value);
  return text + fmt::format("{:g} {:g} {:g}", viseme.pose.seal, viseme.pose.tongue, viseme.hold);
}

const Viseme* FindViseme(const Visemes& visemes, std::string_view name) {
  const auto found = std::ranges::find(visemes, name, &Viseme::name);
  return found == visemes.end() ? nullptr : &*found;
}

namespace {

Viseme ReadViseme(const TableRow& row) {
  if (row.size() != 1 + kShapeValues) {
    row.Refuse(
        fmt::format("{} words found; a name, {} mouth parameters, seal, tongue and hold "
                    "expected",
                    row.size(), kMouthParameters));
  }
  Viseme viseme;
  viseme.name = row.key();
  if (auto read = ReadVisemeValues(row.words(), 1, viseme); !read) row.Refuse(read.error().text);
  return viseme;
}

int VisemeAt(const TableRow& row, std::size_t word, const Visemes& visemes) {
  const std::string& name = row.Word(word);
  if (name == "next") return PhonemeVisemes::kNext;
  const Viseme* const viseme = FindViseme(visemes, name);
  if (viseme == nullptr) row.Refuse("'" + name + "' is neither a mouth shape nor 'next'");
  return static_cast<int>(viseme - visemes.data());
}

PhonemeVisemes ReadPhonemeVisemes(const TableRow& row, const Visemes& visemes) {
  if (row.size() != 3 && row.size() != 5) {
    row.Refuse("a phoneme, then one or two pairs of shape and strength expected");
  }
  PhonemeVisemes out;
  for (std::size_t i = 1; i < row.size(); i += 2) {
    out.phases.push_back(
        {VisemeAt(row, i, visemes), row.Within<double>(i + 1, 0, 2, "a strength")});
  }
  return out;
}

/// Reads KIND JAW LIPS ROUND TONGUE EARLY CONTACT from index 3 on.
void ReadDominanceOf(const TableRow& row, Viseme& viseme) {
  const std::string& kind = row.Word(3);
  if (kind != "vowel" && kind != "consonant" && kind != "pause") {
    row.Refuse("'" + kind + "' found; vowel, consonant or pause expected");
  }
  const auto dominance = [&](std::size_t word) {
    return row.Within<double>(word, 0, 1, "a dominance");
  };
  viseme.dominance = {
      .jaw = dominance(4),
      .lips = dominance(5),
      .round = dominance(6),
      .tongue = dominance(7),
      .early_ms = std::max(1.0, row.Within<double>(8, 0, 500, "ms of anticipation")),
      .vowel = kind == "vowel"};
  viseme.pose.contact = row.Within(9, 0, 1, "a contact");
}

/// Reads the row of a viseme into it, and returns it.
const Viseme* ReadShapeRow(const TableRow& row, std::map<VisemeSetId, VisemeSet>& sets) {
  if (row.key() != "shape" || row.size() != 10) {
    row.Refuse(
        "reach BEFORE AFTER, or shape SET NAME KIND JAW LIPS ROUND TONGUE EARLY CONTACT "
        "expected");
  }
  const std::string& count = row.Word(1);
  const auto id = SetOfCount(ParseNumber<std::size_t>(count).value_or(0));
  if (!id) row.Refuse("'" + count + "' found; set 14 or 28 expected");
  Visemes& set = sets.at(*id).visemes;
  const auto viseme = std::ranges::find(set, row.Word(2), &Viseme::name);
  if (viseme == set.end()) {
    row.Refuse("there is no mouth shape '" + row.Word(2) + "' in set " + count);
  }
  ReadDominanceOf(row, *viseme);
  return &*viseme;
}

}  // namespace

vm::Result<Visemes> ReadVisemes(const std::string& name, std::string_view text, VisemeSetId set) {
  return ReadTable(name, text, [set](const Table& table) {
    Visemes visemes;
    for (const TableRow& row : table.rows()) {
      Viseme viseme = ReadViseme(row);
      if (FindViseme(visemes, viseme.name) != nullptr) {
        row.Refuse("there is a shape '" + viseme.name + "' already");
      }
      visemes.push_back(std::move(viseme));
    }
    if (visemes.size() != CountOf(set)) {
      table.Refuse(fmt::format("{} shapes found, {} expected", visemes.size(), CountOf(set)));
    }
    if (FindViseme(visemes, "rest") == nullptr) {
      table.Refuse("no shape 'rest', which is the mouth of pauses");
    }
    return visemes;
  });
}

vm::Result<PhonemeTable> ReadPhonemeTable(const std::string& name, std::string_view text,
                                          const Visemes& visemes) {
  return ReadTable(name, text, [&visemes](const Table& table) {
    PhonemeTable phonemes;
    for (const TableRow& row : table.rows()) {
      if (!phonemes.emplace(row.key(), ReadPhonemeVisemes(row, visemes)).second) {
        row.Refuse("the phoneme '" + row.key() + "' is here twice");
      }
    }
    if (phonemes.empty()) table.Refuse("no phoneme found");
    return phonemes;
  });
}

vm::Result<DominanceReach> ReadDominance(const std::string& name, std::string_view text,
                                         std::map<VisemeSetId, VisemeSet>& sets) {
  return ReadTable(name, text, [&](const Table& table) {
    DominanceReach reach;
    std::set<const Viseme*> done;
    for (const TableRow& row : table.rows()) {
      if (row.key() == "reach") {
        reach = {row.Within<double>(1, 1, 500, "a reach in ms"),
                 row.Within<double>(2, 1, 500, "a reach in ms")};
      } else {
        done.insert(ReadShapeRow(row, sets));
      }
    }
    for (const auto& [id, set] : sets) {
      for (const Viseme& viseme : set.visemes) {
        if (!done.contains(&viseme))
          table.Refuse("no row for the mouth shape '" + viseme.name + "'");
      }
    }
    return reach;
  });
}

}  // namespace fsm
