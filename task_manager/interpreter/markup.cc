#include "task_manager/interpreter/markup.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace vxml {
namespace {

struct Name {
  std::string_view from;  ///< in capitals
  std::string_view type;
};

// The original's types and their common variants; EmotionML's categories of big6, everyday, occ,
// fsre and frijda by what the face can show of them.
constexpr Name kNames[] = {
    {"HAPPY", "HAPPY"},
    {"ANGRY", "ANGRY"},
    {"DISGUSTED", "DISGUSTED"},
    {"SAD", "SAD"},
    {"SURPRISED", "SURPRISED"},
    {"FEARED", "FEARED"},
    {"NEUTRAL", "NEUTRAL"},
    {"FEAR", "FEARED"},
    {"AFRAID", "FEARED"},
    {"ANGER", "ANGRY"},
    {"DISGUST", "DISGUSTED"},
    {"HAPPINESS", "HAPPY"},
    {"SADNESS", "SAD"},
    {"SURPRISE", "SURPRISED"},
    {"AFFECTIONATE", "HAPPY"},
    {"AMUSED", "HAPPY"},
    {"BORED", "NEUTRAL"},
    {"CONFIDENT", "HAPPY"},
    {"CONTENT", "HAPPY"},
    {"EXCITED", "HAPPY"},
    {"INTERESTED", "SURPRISED"},
    {"LOVING", "HAPPY"},
    {"PLEASED", "HAPPY"},
    {"RELAXED", "NEUTRAL"},
    {"SATISFIED", "HAPPY"},
    {"WORRIED", "FEARED"},
    {"JOY", "HAPPY"},
    {"DISTRESS", "SAD"},
    {"HOPE", "HAPPY"},
    {"RELIEF", "HAPPY"},
    {"DISAPPOINTMENT", "SAD"},
    {"PRIDE", "HAPPY"},
    {"SHAME", "SAD"},
    {"ADMIRATION", "HAPPY"},
    {"REPROACH", "ANGRY"},
    {"LOVE", "HAPPY"},
    {"HATE", "ANGRY"},
    {"GRATIFICATION", "HAPPY"},
    {"REMORSE", "SAD"},
    {"GRATITUDE", "HAPPY"},
    {"RESENTMENT", "ANGRY"},
    {"PITY", "SAD"},
    {"GLOATING", "HAPPY"},
    {"SATISFACTION", "HAPPY"},
    {"FEARS-CONFIRMED", "FEARED"},
    {"HAPPY-FOR", "HAPPY"},
    {"ANXIETY", "FEARED"},
    {"BEING-HURT", "SAD"},
    {"COMPASSION", "SAD"},
    {"CONTEMPT", "DISGUSTED"},
    {"CONTENTMENT", "HAPPY"},
    {"DESPAIR", "SAD"},
    {"GUILT", "SAD"},
    {"INTEREST", "SURPRISED"},
    {"IRRITATION", "ANGRY"},
    {"JEALOUSY", "ANGRY"},
    {"PLEASURE", "HAPPY"},
    {"STRESS", "FEARED"},
    {"DESIRE", "HAPPY"},
    {"ENJOYMENT", "HAPPY"},
    {"INDIFFERENCE", "NEUTRAL"},
    {"RELAXATION", "NEUTRAL"},
};

struct Lexeme {
  std::string_view name;
  std::string_view units;  ///< FACS numbers
};
constexpr Lexeme kLexemes[] = {
    {"OBLIQUE_BROWS", "1 4"},
    {"RAISE_BROWS", "1 2"},
    {"RAISE_LEFT_BROW", "1L 2L"},
    {"RAISE_RIGHT_BROW", "1R 2R"},
    {"LOWER_BROWS", "4"},
    {"LOWER_LEFT_BROW", "4L"},
    {"LOWER_RIGHT_BROW", "4R"},
    {"LOWER_MOUTH_CORNERS", "15"},
    {"LOWER_LEFT_MOUTH_CORNER", "15L"},
    {"LOWER_RIGHT_MOUTH_CORNER", "15R"},
    {"RAISE_MOUTH_CORNERS", "12"},
    {"RAISE_LEFT_MOUTH_CORNER", "12L"},
    {"RAISE_RIGHT_MOUTH_CORNER", "12R"},
    {"OPEN_MOUTH", "26"},
    {"OPEN_LIPS", "25"},
    {"WIDEN_EYES", "5"},
    {"CLOSE_EYES", "43"},
};

constexpr std::string_view kBehaviours[] = {"head",     "gaze",       "gazeShift", "face",
                                            "faceFacs", "faceLexeme", "faceShift"};

std::string Upper(std::string text) {
  for (char& c : text) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 32 : c);
  return text;
}

double Number(const std::string& text, double otherwise) {
  double value = otherwise;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && std::isfinite(value) ? value : otherwise;
}

std::string Short(double value) {
  char digits[40];
  const double rounded = std::round(value * 1000) / 1000;
  return {digits, std::to_chars(digits, digits + sizeof digits, rounded).ptr};
}

std::string_view TypeOf(const std::string& name) {
  const std::string upper = Upper(name);
  for (const Name& known : kNames) {
    if (known.from == upper) return known.type;
  }
  return "";
}

/// Pleasure, arousal, dominance (0..1, 0.5 = neither) to the nearest expression.
Feeling FromDimensions(const vm::xml::Node& emotion) {
  double pleasure = 0.5;
  double arousal = 0.5;
  double dominance = 0.5;
  for (const auto& child : emotion.children) {
    if (!child->IsElement("dimension")) continue;
    const std::string name = child->Get("name");
    const double value = Number(child->Get("value"), 0.5);
    if (name == "pleasure" || name == "valence") pleasure = value;
    if (name == "arousal") arousal = value;
    if (name == "dominance" || name == "potency") dominance = value;
  }
  Feeling feeling;
  const double away = std::max(std::abs(pleasure - 0.5), std::abs(arousal - 0.5)) * 2;
  feeling.strength = static_cast<int>(std::lround(std::clamp(away, 0.0, 1.0) * 100));
  if (away < 0.2) {
    feeling.type = "NEUTRAL";
  } else if (pleasure >= 0.5) {
    feeling.type = arousal > 0.75 && pleasure < 0.65 ? "SURPRISED" : "HAPPY";
  } else if (arousal < 0.5) {
    feeling.type = "SAD";
  } else {
    feeling.type = dominance >= 0.5 ? "ANGRY" : "FEARED";
  }
  return feeling;
}

std::vector<std::string> Units(std::string_view units, double amount) {
  std::vector<std::string> lines;
  while (!units.empty()) {
    const std::size_t end = std::min(units.find(' '), units.size());
    lines.push_back("to @FSM set AU = " + std::string(units.substr(0, end)) + " " + Short(amount) +
                    " 200");
    units.remove_prefix(std::min(end + 1, units.size()));
  }
  return lines;
}

std::vector<std::string> Head(const vm::xml::Node& node) {
  const std::string lexeme = Upper(node.Get("lexeme", node.Get("type", "NOD")));
  const char* motion = lexeme == "SHAKE" ? "REFUSE" : lexeme == "TILT" ? "LISTEN" : "NOD";
  const int turns =
      std::clamp(static_cast<int>(Number(node.Get("repetition", node.Get("repeats")), 1)), 1, 10);
  return std::vector<std::string>(static_cast<std::size_t>(turns),
                                  std::string("to @FSM set FaceMot = ") + motion + " 1");
}

std::vector<std::string> Gaze(const vm::xml::Node& node) {
  double down = Number(node.Get("x"), 0);
  double right = Number(node.Get("y"), 0);
  const double angle = Number(node.Get("offsetAngle"), 0);
  const std::string direction = Upper(node.Get("offsetDirection"));
  if (direction.find("LEFT") != std::string::npos) right = -angle;
  if (direction.find("RIGHT") != std::string::npos) right = angle;
  if (direction.find("UP") != std::string::npos) down = -angle;
  if (direction.find("DOWN") != std::string::npos) down = angle;
  return {"to @FSM set Gaze = " + Short(std::clamp(down, -60.0, 60.0)) + " " +
          Short(std::clamp(right, -60.0, 60.0))};
}

std::vector<std::string> Face(const vm::xml::Node& node) {
  const double amount = std::clamp(Number(node.Get("amount"), 1), 0.0, 1.0);
  if (const std::string unit = node.Get("au"); !unit.empty()) {
    const std::string side = Upper(node.Get("side", "BOTH"));
    const std::string letter = side == "LEFT" ? "L" : side == "RIGHT" ? "R" : "";
    return Units(unit.substr(0, unit.find_first_not_of("0123456789")) + letter, amount);
  }
  const std::string name = Upper(node.Get("lexeme", node.Get("type")));
  for (const Lexeme& lexeme : kLexemes) {
    if (lexeme.name == name) return Units(lexeme.units, amount);
  }
  if (const std::string_view type = TypeOf(name); !type.empty()) {
    return {FaceCommand({std::string(type), 1, static_cast<int>(std::lround(amount * 100))})};
  }
  return {};
}

}  // namespace

std::optional<Feeling> ReadFeeling(const vm::xml::Node& emotion) {
  Feeling feeling;
  std::string name = emotion.Get("type", emotion.Get("name"));
  double value = 100;
  if (const std::string* given = emotion.Find("value")) {
    value = Number(*given, 100);
    if (value <= 1 && given->find('.') != std::string::npos) value *= 100;  // EmotionML's 0..1
  }
  feeling.pattern = std::clamp(static_cast<int>(Number(emotion.Get("pattern"), 1)), 1, 5);
  bool dimensions = false;
  double best = -1;
  for (const auto& child : emotion.children) {
    dimensions = dimensions || child->IsElement("dimension");
    if (child->IsElement("intensity")) value = Number(child->Get("value"), 1) * 100;
    if (!child->IsElement("category")) continue;
    const double amount = Number(child->Get("value"), 1);
    if (amount <= best) continue;
    best = amount;
    name = child->Get("name");
  }
  if (best >= 0) value = best * 100;
  if (name.empty() && dimensions) return FromDimensions(emotion);
  if (name.empty()) return feeling;
  const std::string_view type = TypeOf(name);
  if (type.empty()) return {};
  feeling.type = type;
  feeling.strength = static_cast<int>(std::lround(std::clamp(value, 0.0, 200.0)));
  if (feeling.strength == 0) feeling.type = "NEUTRAL";
  return feeling;
}

std::string FaceCommand(const Feeling& feeling) {
  if (feeling.type == "NEUTRAL") return "to @FSM set FaceExp = NEUTRAL";
  return "to @FSM set FaceExp = " + feeling.type + " " + std::to_string(feeling.pattern) + " " +
         std::to_string(feeling.strength) + " 0";
}

bool IsBehaviour(const std::string& name) {
  return std::find(std::begin(kBehaviours), std::end(kBehaviours), name) != std::end(kBehaviours);
}

std::vector<std::string> BehaviourCommands(const vm::xml::Node& node) {
  if (node.name == "head") return Head(node);
  if (node.name == "gaze" || node.name == "gazeShift") return Gaze(node);
  if (node.name == "faceShift") {
    std::vector<std::string> lines;
    for (const auto& child : node.children) {
      if (!child->IsElement()) continue;
      for (std::string& line : BehaviourCommands(*child)) lines.push_back(std::move(line));
    }
    if (lines.empty()) lines.push_back(FaceCommand(Feeling{}));
    return lines;
  }
  if (IsBehaviour(node.name)) return Face(node);
  return {};
}

}  // namespace vxml
