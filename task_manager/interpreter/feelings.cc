#include "task_manager/interpreter/feelings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

#include "embedded/feelings.h"
#include "task_manager/document/schema.h"
#include "task_manager/document/values.h"

namespace vxml {
namespace {

constexpr std::string_view kKinds = "category appraisal action-tendency";
constexpr std::string_view kTypes = "HAPPY ANGRY DISGUSTED SAD SURPRISED FEARED NEUTRAL";

std::string Upper(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 32 : c);
  return upper;
}

using Table = std::map<std::pair<std::string, std::string>, NamedFeeling>;

const Table& BuiltIn() {
  static const Table table = [] {
    auto rows = ParseFeelings(embedded::feelings(), "feelings.txt");
    if (!rows) throw std::runtime_error(rows.error().text);
    Table made;
    for (NamedFeeling& row : *rows) made.emplace(std::pair(row.kind, row.name), std::move(row));
    return made;
  }();
  return table;
}

/// Pleasure, arousal, dominance, unpredictability (0..1, 0.5 = neither) to the nearest expression.
Feeling FromDimensions(const vm::xml::Node& emotion) {
  double pleasure = 0.5;
  double arousal = 0.5;
  double dominance = 0.5;
  double surprise = 0.5;
  for (const auto& child : emotion.children) {
    if (!child->IsElement("dimension")) continue;
    const std::string name = child->Get("name");
    const double value = NumberIn(child->Get("value"), 0, 1, 0.5);
    if (name == "pleasure" || name == "valence") pleasure = value;
    if (name == "arousal") arousal = value;
    if (name == "dominance" || name == "potency") dominance = value;
    if (name == "unpredictability") surprise = value;
  }
  Feeling feeling;
  const double away =
      std::max({std::abs(pleasure - 0.5), std::abs(arousal - 0.5), surprise - 0.5}) * 2;
  feeling.strength = static_cast<int>(std::lround(std::clamp(away, 0.0, 1.0) * 100));
  if (away < 0.2) {
    feeling.type = "NEUTRAL";
  } else if (surprise - 0.5 >= std::abs(pleasure - 0.5) && surprise > 0.5) {
    feeling.type = "SURPRISED";
  } else if (pleasure >= 0.5) {
    feeling.type = arousal > 0.75 && pleasure < 0.65 ? "SURPRISED" : "HAPPY";
  } else if (arousal < 0.5) {
    feeling.type = "SAD";
  } else {
    feeling.type = dominance >= 0.5 ? "ANGRY" : "FEARED";
  }
  return feeling;
}

/// A named part of an emotion and how much of it there is.
struct Named {
  std::string kind = "category";
  std::string name{};
  double amount = 1;
};

/// The strongest of the emotion's children of these kinds; of equal ones the first.
std::optional<Named> Strongest(const vm::xml::Node& emotion, std::string_view kinds) {
  std::optional<Named> best;
  for (const auto& child : emotion.children) {
    if (!child->IsElement() || !HasWord(kinds, child->name)) continue;
    const double amount = NumberIn(child->Get("value"), 0, 1, 1);
    if (!best || amount > best->amount) best = Named{child->name, child->Get("name"), amount};
  }
  return best;
}

/// What <emotion type="..." value="..."> itself says.
std::optional<Named> Own(const vm::xml::Node& emotion) {
  Named named{.name = emotion.Get("type", emotion.Get("name"))};
  if (named.name.empty()) return {};
  if (const std::string* given = emotion.Find("value")) {
    const double value = NumberIn(*given, -1000, 1000, 100);
    // EmotionML's 0..1 is told from the original's per cent by its point.
    const bool share = value <= 1 && given->find('.') != std::string::npos;
    named.amount = share ? value : value / 100;
  }
  return named;
}

}  // namespace

vm::Result<std::vector<NamedFeeling>> ParseFeelings(std::string_view text,
                                                    const std::string& name) {
  std::vector<NamedFeeling> rows;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    NamedFeeling row;
    if (!(words >> row.kind) || row.kind.starts_with('#')) continue;
    const auto bad = [&](const std::string& what) {
      return vm::Fail(vm::Errc::kSyntax, name + ":" + std::to_string(number) + ": " + what);
    };
    std::string rest;
    if (!(words >> row.name >> row.type >> row.strength) || words >> rest) {
      return bad("expected KIND NAME EXPRESSION STRENGTH");
    }
    row.name = Upper(row.name);
    if (!HasWord(kKinds, row.kind)) {
      return bad("'" + row.kind + "', expected one of " + std::string(kKinds));
    }
    if (!HasWord(kTypes, row.type)) {
      return bad("'" + row.type + "', expected one of " + std::string(kTypes));
    }
    if (row.strength < 0 || row.strength > 200) return bad("a strength of 0 to 200 expected");
    rows.push_back(std::move(row));
  }
  return rows;
}

const NamedFeeling* FindFeeling(std::string_view kind, const std::string& name) {
  const auto found = BuiltIn().find({std::string(kind), Upper(name)});
  return found == BuiltIn().end() ? nullptr : &found->second;
}

std::optional<Feeling> ReadFeeling(const vm::xml::Node& emotion) {
  Feeling feeling;
  std::optional<Named> named = Strongest(emotion, "category");
  if (!named) named = Own(emotion);
  const vm::xml::Node* intensity = emotion.FirstElement("intensity");
  if (named && intensity) named->amount = NumberIn(intensity->Get("value"), 0, 1, 1);
  if (!named && emotion.FirstElement("dimension")) {
    feeling = FromDimensions(emotion);
  } else if (!named) {
    named = Strongest(emotion, "appraisal action-tendency");
  }
  if (named) {
    const NamedFeeling* shown = FindFeeling(named->kind, named->name);
    if (!shown) return {};
    feeling.type = shown->type;
    feeling.strength =
        static_cast<int>(std::lround(std::clamp(named->amount * shown->strength, 0.0, 200.0)));
    if (feeling.strength == 0) feeling.type = "NEUTRAL";
  }
  feeling.pattern = static_cast<int>(NumberIn(emotion.Get("pattern"), 1, 5, 1));
  if (const std::string* through = emotion.Find("expressed-through")) {
    feeling.on_face = HasWord(*through, "face");
    feeling.in_voice = HasWord(*through, "voice");
  }
  return feeling;
}

std::string FaceCommand(const Feeling& feeling) {
  if (feeling.type == "NEUTRAL") return "to @FSM set FaceExp = NEUTRAL";
  return "to @FSM set FaceExp = " + feeling.type + " " + std::to_string(feeling.pattern) + " " +
         std::to_string(feeling.strength) + " 0";
}

}  // namespace vxml
