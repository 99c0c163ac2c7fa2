#include "face_editor/app/script_hand.h"

#include <fmt/format.h>

#include "fsm/base/parse_number.h"

namespace editor {

using vm::Errc;
using vm::Fail;

vm::Result<std::vector<float>> Numbers(const std::vector<std::string>& words, std::size_t first,
                                       std::size_t count) {
  std::vector<float> numbers;
  for (std::size_t i = first; i < words.size(); ++i) {
    const auto number = fsm::ParseNumber(words[i]);
    if (!number) return Fail(Errc::kBadValue, "'" + words[i] + "' is not a number");
    numbers.push_back(static_cast<float>(*number));
  }
  if (numbers.size() != count) {
    return Fail(Errc::kSyntax, fmt::format("{} numbers found, {} expected", numbers.size(), count));
  }
  return numbers;
}

void Draw(Program& program, int frames) {
  for (int i = 0; i < frames; ++i) static_cast<void>(program.frame(""));
}

namespace {

void Press(Program& program, bool down) {
  program.ui.window.hand->down[0] = down;
  Draw(program, 2);
}

void MoveHand(Program& program, ImVec2 to) {
  auto& hand = program.ui.window.hand;
  if (!hand) hand = Window::Hand();
  hand->x = to.x;
  hand->y = to.y;
  Draw(program, 2);
}

}  // namespace

void ClickAt(Program& program, ImVec2 place) {
  MoveHand(program, place);
  Press(program, true);
  Press(program, false);
}

vm::Result<std::string> MoveMouse(Program& program, const std::vector<std::string>& words) {
  const std::string what = words.size() > 1 ? words[1] : "";
  auto& hand = program.ui.window.hand;
  if (what == "off") {
    hand.reset();
    return "";
  }
  const std::size_t count = what == "move" ? 2 : what == "drag" ? 4 : what == "wheel" ? 1 : 0;
  const auto at = Numbers(words, 2, count);
  if (!at) return std::unexpected(at.error());
  const std::vector<float>& v = *at;
  if (!hand && what != "move" && what != "drag") {
    return Fail(Errc::kBadValue, "mouse move X Y comes first");
  }
  if (what == "move") {
    MoveHand(program, {v[0], v[1]});
  } else if (what == "down" || what == "up") {
    Press(program, what == "down");
  } else if (what == "wheel") {
    hand->wheel = v[0];
    Draw(program, 2);
  } else if (what == "drag") {
    MoveHand(program, {v[0], v[1]});
    Press(program, true);
    constexpr int kSteps = 4;
    for (int i = 1; i <= kSteps; ++i) {
      const float part = static_cast<float>(i) / kSteps;
      MoveHand(program, {v[0] + part * (v[2] - v[0]), v[1] + part * (v[3] - v[1])});
    }
    Press(program, false);
  } else {
    return Fail(Errc::kSyntax, "mouse move, down, up, wheel, drag or off expected");
  }
  return "";
}

}  // namespace editor
