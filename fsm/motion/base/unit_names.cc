#include "fsm/motion/base/unit_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <span>
#include <utility>

#include "embedded/action_unit_names.h"
#include "fsm/base/parse_number.h"
#include "fsm/base/table_reader.h"
#include "fsm/base/words.h"
#include "vm_protocol/core/lower_case.h"

namespace fsm {

namespace {

struct Word {
  std::string_view text;
  std::size_t column;  // counted from 1
};

// Splits a text at blanks; "12:0.7" gives two words, "gaze:6,0" one.
std::vector<Word> UnitWordsOf(std::string_view text) {
  std::vector<Word> words;
  const auto add = [&](std::string_view word) {
    if (!word.empty()) {
      words.push_back({word, static_cast<std::size_t>(word.data() - text.data()) + 1});
    }
  };
  for (std::string_view word : WordsOf(text)) {
    while (!word.starts_with("gaze") && word.contains(':')) add(ReadUntil(":", word));
    add(word);
  }
  return words;
}

std::unexpected<vm::Error> FailAt(const Word& word, std::string_view what) {
  return vm::Fail(vm::Errc::kBadValue, fmt::format("'{}' at column {} is {}",
                                                   word.text.substr(0, 60), word.column, what));
}

std::optional<double> IntensityOf(std::string_view word) {
  if (word.size() != 1 || word[0] < 'A' || word[0] > 'E') return std::nullopt;
  return kIntensity[static_cast<std::size_t>(word[0] - 'A')];
}

Sided<bool> OnlySide(bool left) { return {.right = !left, .left = left}; }

/// A unit with its side, and its strength if the word has an intensity letter (12C).
struct ParsedUnit {
  UnitSetting unit;
  bool strength_given = false;
};

std::optional<ParsedUnit> ByName(std::string_view word, const UnitNames& names) {
  ParsedUnit out;
  const std::string lower = vm::LowerCase(word);
  std::string_view name = lower;
  auto found = names.by_name.find(name);
  if (found == names.by_name.end() && (name.ends_with('l') || name.ends_with('r'))) {
    out.unit.sides = OnlySide(name.ends_with('l'));
    name.remove_suffix(1);
    const bool numbered = !name.empty() && name.front() >= '0' && name.front() <= '9';
    if (!numbered && !name.ends_with('.')) return std::nullopt;
    if (name.ends_with('.')) name.remove_suffix(1);
    found = names.by_name.find(name);
  }
  if (found == names.by_name.end()) return std::nullopt;
  out.unit.number = found->second;
  return out;
}

std::optional<ParsedUnit> ByNumber(std::string_view word) {
  ParsedUnit out;
  std::optional<char> side;
  const auto take_side = [&](char c) {
    if (c == 'l' || c == 'r') c = static_cast<char>(c - 'a' + 'A');
    if (side || (c != 'L' && c != 'R')) return false;
    side = c;
    return true;
  };
  if (!word.empty() && take_side(word.front())) word.remove_prefix(1);
  const auto [end, error] =
      std::from_chars(word.data(), word.data() + word.size(), out.unit.number);
  if (error != std::errc{} || word.starts_with('-')) return std::nullopt;
  word.remove_prefix(static_cast<std::size_t>(end - word.data()));
  if (!word.empty() && take_side(word.front())) word.remove_prefix(1);
  if (const auto letter = IntensityOf(word)) {
    out.unit.strength = *letter;
    out.strength_given = true;
    word = {};
  }
  if (!word.empty()) return std::nullopt;
  if (side) out.unit.sides = OnlySide(*side == 'L');
  return out;
}

std::optional<ParsedUnit> FindUnit(std::string_view word, const UnitNames& names) {
  auto unit = ByName(word, names);
  if (!unit) unit = ByNumber(word);
  if (unit && !names.names.contains(unit->unit.number)) return std::nullopt;
  return unit;
}

/// Returns the unit numbers in use as ranges, "1-2, 4-39, 158".
std::string NumbersInUse(const UnitNames& names) {
  std::string text;
  for (auto at = names.names.begin(); at != names.names.end();) {
    const int first = at->first;
    int last = first;
    while (++at != names.names.end() && at->first == last + 1) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", first);
    if (last > first) text += fmt::format("-{}", last);
  }
  return text;
}

/// Returns names similar to a word, for messages: those with the longest common prefix, of equals
/// those with the greatest numbers, since user-defined units have these.
std::string NamesLike(std::string_view word, const UnitNames& names) {
  constexpr std::size_t kMax = 5;
  const std::string wanted = vm::LowerCase(word);
  std::vector<std::pair<std::ptrdiff_t, int>> ranked;  // length of the common prefix, number
  for (const auto& [number, name] : names.names) {
    const std::string lower = vm::LowerCase(name);
    ranked.emplace_back(std::ranges::mismatch(wanted, lower).in1 - wanted.begin(), number);
  }
  std::ranges::sort(ranked, std::greater<>());
  std::string text;
  for (std::size_t i = 0; i < std::min(kMax, ranked.size()); ++i) {
    text += (i > 0 ? ", " : "") + names.names.at(ranked[i].second).substr(0, 40);
  }
  return text;
}

/// Returns the text of what is expected in place of a unit.
std::string UnitsExpected(std::string_view word, const UnitNames& names) {
  return fmt::format(
      "a number ({}) or name of action_unit_names.txt (such as {}) expected, with L or R for one "
      "side",
      NumbersInUse(names), NamesLike(word, names));
}

vm::Result<ParsedUnit> ParseUnit(const Word& word, const UnitNames& names) {
  const auto unit = FindUnit(word.text, names);
  if (!unit) return FailAt(word, "not an action unit; " + UnitsExpected(word.text, names));
  if (names.codes.contains(unit->unit.number) && unit->unit.sides != Sided<bool>{true, true}) {
    return FailAt(word, "a code of head or eyes, which has no sides");
  }
  return *unit;
}

vm::Result<double> ParseStrength(const Word& word) {
  if (const auto letter = IntensityOf(word.text)) return *letter;
  const auto number = ParseNumber(word.text);
  if (!number || *number < 0 || *number > kMaxStrength) {
    return FailAt(word,
                  fmt::format("no strength; a number from 0 to {:g} (1 = full) or a letter A to E "
                              "expected",
                              kMaxStrength));
  }
  return *number;
}

std::unexpected<vm::Error> FailEmpty() {
  return vm::Fail(vm::Errc::kBadValue,
                  "nothing found where units and strengths are expected, as '12L 0.7 6 C'");
}

/// Takes a unit from the front of the words, and its strength if its own word does not have it.
/// REQUIRES: there are words.
vm::Result<ParsedUnit> ReadUnit(std::span<const Word>& words, const UnitNames& names) {
  auto unit = ParseUnit(words[0], names);
  if (!unit) return unit;
  if (!unit->strength_given) {
    if (words.size() == 1) return FailAt(words[0], "without a strength after it");
    const auto strength = ParseStrength(words[1]);
    if (!strength) return std::unexpected(strength.error());
    unit->unit.strength = *strength;
  }
  words = words.subspan(unit->strength_given ? 1 : 2);
  KeepOwnSide(unit->unit, names);
  return unit;
}

void SetUnit(FaceLook& look, const UnitSetting& unit) {
  const auto index = static_cast<std::size_t>(unit.number);
  for (const Side side : kSides) {
    if (unit.sides[side]) look.au[side][index] = static_cast<float>(unit.strength);
  }
}

/// Sets the gaze by a word gaze[L|R]:DOWN,RIGHT (degrees); returns false for any other word.
bool SetGaze(FaceLook& look, std::string_view word) {
  const std::string_view key = ReadUntil(":", word);
  const auto down = ParseNumber(ReadUntil(",", word)), right = ParseNumber(word);
  if ((key != "gaze" && key != "gazeL" && key != "gazeR") || !down || !right) return false;
  const EyeAngles angles{static_cast<float>(*down), static_cast<float>(*right)};
  if (key != "gazeR") look.gaze.left = angles;
  if (key != "gazeL") look.gaze.right = angles;
  return true;
}

HeadEyeCode ReadCode(const TableRow& row) {
  std::array<float, 8> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    v[i] = row.Within(3 + i, -60, 60, "an angle or a part");
  }
  return {.head_rotation = {v[0], v[1], v[2]},
          .gaze = {.right = {v[5], v[6]}, .left = {v[3], v[4]}},
          .head_forward_mm = v[7]};
}

void ReadNameRow(const TableRow& row, UnitNames& out) {
  const bool code = row.key() == "code";
  const bool one_sided = !code && row.words().back() == "one-sided";
  const std::size_t count = row.size() - (one_sided ? 1 : 0);
  if ((!code && row.key() != "unit") || count != (code ? 11u : 3u)) {
    row.Refuse("unit NUMBER NAME [one-sided], or code NUMBER NAME and 8 numbers expected");
  }
  const int unit =
      static_cast<int>(row.Within<double>(1, 1, UnitValues::kMax, "a number of a unit"));
  const std::string& name = row.Word(2);
  if (ByNumber(name)) row.Refuse("'" + name + "' reads as a number, not as a name");
  if (out.names.contains(unit)) {
    row.Refuse(
        fmt::format("the number {} is here twice, for '{}' and '{}'", unit, out.names[unit], name));
  }
  const auto [named, fresh] = out.by_name.emplace(vm::LowerCase(name), unit);
  if (!fresh) {
    row.Refuse(
        fmt::format("the name '{}' is here twice, for {} and {} (capitals and small letters "
                    "are the same)",
                    name, named->second, unit));
  }
  out.names[unit] = name;
  if (one_sided) out.one_sided.insert(unit);
  if (code) out.codes[unit] = ReadCode(row);
}

}  // namespace

vm::Result<UnitNames> ReadUnitNames(const std::string& name, std::string_view text) {
  return ReadTable(name, text, [](const Table& table) {
    UnitNames out;
    for (const TableRow& row : table.rows()) ReadNameRow(row, out);
    return out;
  });
}

const UnitNames& UnitNames::BuiltIn() {
  static const UnitNames names =
      ReadUnitNames("action_unit_names.txt", embedded::action_unit_names()).value();
  return names;
}

vm::Result<UnitName> ParseUnitName(std::string_view word, const UnitNames& names) {
  const auto unit = FindUnit(word, names);
  if (unit && !unit->strength_given && names.IsUnit(unit->unit.number)) return unit->unit;
  return vm::Fail(vm::Errc::kBadValue, fmt::format("'{}' is not an action unit; {}",
                                                   word.substr(0, 60), UnitsExpected(word, names)));
}

void KeepOwnSide(UnitSetting& unit, const UnitNames& names) {
  if (unit.sides.left && unit.strength > 0 && names.IsOneSided(unit.number))
    unit.sides.right = false;
}

vm::Result<UnitCommand> ParseUnitCommand(std::string_view text, const UnitNames& names) {
  const std::vector<Word> all = UnitWordsOf(text);
  if (all.empty()) return FailEmpty();
  UnitCommand out;
  bool lettered = false;  // the previous unit has an intensity letter
  for (std::span<const Word> words(all); !words.empty();) {
    // A single number at the end, after at least one unit, is a time.
    const auto ms =
        words.size() == 1 && !out.settings.empty() ? ParseNumber(words[0].text) : std::nullopt;
    if (ms) {
      if (lettered && *ms > 0 && *ms <= kMaxStrength) {
        return FailAt(words[0], fmt::format("a second strength: '{}' says its own by a letter; a "
                                            "time of more than {:g} ms expected, or none",
                                            all[all.size() - 2].text.substr(0, 60), kMaxStrength));
      }
      if (*ms < 0 || *ms > 86400000) return FailAt(words[0], "no time; 0 to 86400000 ms expected");
      out.ms = *ms;
      break;
    }
    const auto taken = ReadUnit(words, names);
    if (!taken) return std::unexpected(taken.error());
    lettered = taken->strength_given;
    out.settings.push_back(taken->unit);
  }
  return out;
}

std::string FormatLook(const FaceLook& look, const UnitNames& names) {
  std::string text;
  const auto add = [&text](const std::string& word) { text += (text.empty() ? "" : " ") + word; };
  for (std::size_t unit = 0; unit < std::max(look.au.left.size(), look.au.right.size()); ++unit) {
    const float left = look.au.left[unit], right = look.au.right[unit];
    if (left == right && left != 0 && !names.IsOneSided(static_cast<int>(unit))) {
      add(fmt::format("{}:{:g}", unit, left));
      continue;
    }
    if (left != 0) add(fmt::format("{}L:{:g}", unit, left));
    if (right != 0) add(fmt::format("{}R:{:g}", unit, right));
  }
  const auto gaze = [&](const char* side, const EyeAngles& angles) {
    if (angles != EyeAngles{}) {
      add(fmt::format("gaze{}:{:g},{:g}", side, angles[kDown], angles[kToRight]));
    }
  };
  const bool both = look.gaze.left == look.gaze.right;
  gaze(both ? "" : "L", look.gaze.left);
  if (!both) gaze("R", look.gaze.right);
  return text;
}

vm::Result<FaceLook> ParseLook(std::string_view text, const UnitNames& names) {
  const std::vector<Word> all = UnitWordsOf(text);
  if (all.empty()) return FailEmpty();
  FaceLook look;
  for (std::span<const Word> words(all); !words.empty();) {
    if (words[0].text.starts_with("gaze")) {
      if (!SetGaze(look, words[0].text)) {
        return FailAt(words[0], "no direction; gaze:DOWN,RIGHT in degrees expected");
      }
      words = words.subspan(1);
      continue;
    }
    const auto taken = ReadUnit(words, names);
    if (!taken) return std::unexpected(taken.error());
    if (!names.IsUnit(taken->unit.number)) {
      return vm::Fail(vm::Errc::kBadValue,
                      fmt::format("{} is a code of head or eyes, which an expression cannot hold; "
                                  "action units and gaze:DOWN,RIGHT expected",
                                  taken->unit.number));
    }
    SetUnit(look, taken->unit);
  }
  return look;
}

}  // namespace fsm
