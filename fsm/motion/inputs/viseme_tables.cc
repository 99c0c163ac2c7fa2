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
  double lowest, highest;
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

vm::Result<void> ReadVisemeValues(const std::vector<std::string>& words, std::size_t first,
                                  Viseme& viseme) {
  const std::size_t count = words.size() - std::min(first, words.size());
  if (count < kMouthParameters || count > kShapeValues) {
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("{} numbers found; 17 mouth parameters, and up to three more for "
                                "seal, tongue and hold, expected",
                                count));
  }
  Viseme out = viseme;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [what, lowest, highest] = ValueAt(i);
    const auto value = ParseNumber(words[first + i]);
    if (!value || *value < lowest || *value > highest) {
      return vm::Fail(vm::Errc::kBadValue,
                      fmt::format("'{}' found, {} expected, a number from {:g} to {:g}",
                                  words[first + i], what, lowest, highest));
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
    row.Fail(
        fmt::format("{} words found; a name, 17 mouth parameters, seal, tongue and hold "
                    "expected",
                    row.size()));
  }
  Viseme viseme;
  viseme.name = row.key();
  if (auto read = ReadVisemeValues(row.words(), 1, viseme); !read) row.Fail(read.error().text);
  return viseme;
}

int VisemeAt(const TableRow& row, std::size_t word, const Visemes& visemes) {
  const std::string& name = row.Word(word);
  if (name == "next") return PhonemeVisemes::kNext;
  const Viseme* const viseme = FindViseme(visemes, name);
  if (viseme == nullptr) row.Fail("'" + name + "' is neither a mouth shape nor 'next'");
  return static_cast<int>(viseme - visemes.data());
}

PhonemeVisemes ReadPhonemeVisemes(const TableRow& row, const Visemes& visemes) {
  if (row.size() != 3 && row.size() != 5) {
    row.Fail("a phoneme, then one or two pairs of shape and strength expected");
  }
  PhonemeVisemes out;
  for (std::size_t i = 1; i < row.size(); i += 2) {
    out.phases.push_back({VisemeAt(row, i, visemes), row.Number(i + 1, "a strength", 0, 2)});
  }
  return out;
}

/// Reads KIND JAW LIPS ROUND TONGUE EARLY CONTACT from index 3 on.
void ReadDominanceOf(const TableRow& row, Viseme& viseme) {
  const std::string& kind = row.Word(3);
  if (kind != "vowel" && kind != "consonant" && kind != "pause") {
    row.Fail("'" + kind + "' found; vowel, consonant or pause expected");
  }
  const auto dominance = [&](std::size_t word) { return row.Number(word, "a dominance", 0, 1); };
  viseme.dominance = {.jaw = dominance(4),
                      .lips = dominance(5),
                      .round = dominance(6),
                      .tongue = dominance(7),
                      .early_ms = std::max(1.0, row.Number(8, "ms of anticipation", 0, 500)),
                      .vowel = kind == "vowel"};
  viseme.pose.contact = static_cast<float>(row.Number(9, "a contact", 0, 1));
}

/// Reads the row of a viseme into it, and returns it.
const Viseme* ReadShapeRow(const TableRow& row, Visemes& set14, Visemes& set28) {
  if (row.key() != "shape" || row.size() != 10) {
    row.Fail(
        "reach BEFORE AFTER, or shape SET NAME KIND JAW LIPS ROUND TONGUE EARLY CONTACT "
        "expected");
  }
  const std::string& count = row.Word(1);
  if (count != "14" && count != "28") row.Fail("'" + count + "' found; set 14 or 28 expected");
  Visemes& set = count == "14" ? set14 : set28;
  const auto viseme = std::ranges::find(set, row.Word(2), &Viseme::name);
  if (viseme == set.end()) {
    row.Fail("there is no mouth shape '" + row.Word(2) + "' in set " + count);
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
        row.Fail("there is a shape '" + viseme.name + "' already");
      }
      visemes.push_back(std::move(viseme));
    }
    if (visemes.size() != CountOf(set)) {
      table.Fail(fmt::format("{} shapes found, {} expected", visemes.size(), CountOf(set)));
    }
    if (FindViseme(visemes, "rest") == nullptr) {
      table.Fail("no shape 'rest', which is the mouth of pauses");
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
        row.Fail("the phoneme '" + row.key() + "' is here twice");
      }
    }
    if (phonemes.empty()) table.Fail("no phoneme found");
    return phonemes;
  });
}

vm::Result<DominanceReach> ReadDominance(const std::string& name, std::string_view text,
                                         Visemes& set14, Visemes& set28) {
  return ReadTable(name, text, [&](const Table& table) {
    DominanceReach reach;
    std::set<const Viseme*> done;
    for (const TableRow& row : table.rows()) {
      if (row.key() == "reach") {
        reach = {row.Number(1, "a reach in ms", 1, 500), row.Number(2, "a reach in ms", 1, 500)};
      } else {
        done.insert(ReadShapeRow(row, set14, set28));
      }
    }
    for (const Visemes* set : {&set14, &set28}) {
      for (const Viseme& viseme : *set) {
        if (!done.contains(&viseme)) table.Fail("no row for the mouth shape '" + viseme.name + "'");
      }
    }
    return reach;
  });
}

}  // namespace fsm
