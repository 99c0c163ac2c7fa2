#include "task_manager/interpreter/markup.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "task_manager/document/values.h"

namespace vxml {
namespace {

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

std::string Short(double value) {
  char digits[40];
  const double rounded = std::round(value * 1000) / 1000;
  return {digits, std::to_chars(digits, digits + sizeof digits, rounded).ptr};
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
      static_cast<int>(NumberIn(node.Get("repetition", node.Get("repeats")), 1, 10, 1));
  return std::vector<std::string>(static_cast<std::size_t>(turns),
                                  std::string("to @FSM set FaceMot = ") + motion + " 1");
}

std::vector<std::string> Gaze(const vm::xml::Node& node) {
  double down = NumberIn(node.Get("x"), -180, 180, 0);
  double right = NumberIn(node.Get("y"), -180, 180, 0);
  const double angle = NumberIn(node.Get("offsetAngle"), -180, 180, 0);
  const std::string direction = Upper(node.Get("offsetDirection"));
  if (direction.find("LEFT") != std::string::npos) right = -angle;
  if (direction.find("RIGHT") != std::string::npos) right = angle;
  if (direction.find("UP") != std::string::npos) down = -angle;
  if (direction.find("DOWN") != std::string::npos) down = angle;
  return {"to @FSM set Gaze = " + Short(std::clamp(down, -60.0, 60.0)) + " " +
          Short(std::clamp(right, -60.0, 60.0))};
}

std::vector<std::string> Face(const vm::xml::Node& node) {
  const double amount = NumberIn(node.Get("amount"), 0, 1, 1);
  if (const std::string unit = node.Get("au"); !unit.empty()) {
    const std::string side = Upper(node.Get("side", "BOTH"));
    const std::string letter = side == "LEFT" ? "L" : side == "RIGHT" ? "R" : "";
    return Units(unit.substr(0, unit.find_first_not_of("0123456789")) + letter, amount);
  }
  const std::string name = Upper(node.Get("lexeme", node.Get("type")));
  for (const Lexeme& lexeme : kLexemes) {
    if (lexeme.name == name) return Units(lexeme.units, amount);
  }
  if (const NamedFeeling* shown = FindFeeling("category", name)) {
    return {FaceCommand({.type = shown->type,
                         .strength = static_cast<int>(std::lround(amount * shown->strength))})};
  }
  return {};
}

}  // namespace

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
