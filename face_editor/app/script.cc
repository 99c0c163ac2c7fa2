#include "face_editor/app/script.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "face_editor/app/script_hand.h"
#include "face_editor/core/commands.h"
#include "fsm/base/parse_number.h"
#include "fsm/motion/base/unit_names.h"

namespace editor {

using vm::Errc;
using vm::Fail;

std::optional<std::string> LineSource::Next() {
  while (true) {
    const std::size_t newline = text_.find('\n');
    if (newline != std::string::npos || text_.size() > kMaxLineBytes ||
        (ended_ && !text_.empty())) {
      const std::size_t length = std::min({newline, text_.size(), kMaxLineBytes});
      std::string line = text_.substr(0, length);
      text_.erase(0, newline == std::string::npos ? length : newline + 1);
      ++line_;
      return line;
    }
    if (ended_) return std::nullopt;
    pollfd ready{descriptor_, POLLIN, 0};
    if (::poll(&ready, 1, 0) <= 0) return std::nullopt;
    std::array<char, 4096> bytes;
    const ssize_t n = ::read(descriptor_, bytes.data(), bytes.size());
    if (n <= 0) ended_ = true;
    if (n > 0) text_.append(bytes.data(), static_cast<std::size_t>(n));
  }
}

namespace {

using LineWords = std::vector<std::string>;
using Answer = vm::Result<std::string>;

Answer Done(vm::Result<void> result) {
  if (!result) return std::unexpected(result.error());
  return "";
}

int PatternIn(const LineWords& words, std::size_t at) {
  const auto number = at < words.size() ? fsm::ParseNumber(words[at]) : 1.0;
  return number ? static_cast<int>(*number) : 0;
}

Answer Turn(Program& program, const LineWords& words) {
  for (const PageName& page : kPages) {
    if (words.size() == 2 && words[1] == page.word) {
      program.ui.page = page.page;
      program.ui.player.Stop();
      // The tabs need a few frames to follow.
      for (int i = 0; i < 4; ++i) static_cast<void>(program.frame(""));
      return "";
    }
  }
  return Fail(Errc::kBadValue,
              "points, units, fields, expressions, mouth, motions or identity expected");
}

Answer Play(Program& program, const LineWords& words) {
  Show show;
  const std::string kind = words.size() > 1 ? words[1] : "";
  if (kind == "expression" && words.size() > 2) {
    show.expression = words[2];
    show.pattern = PatternIn(words, 3);
    show.elicited = program.ui.elicited;
  } else if (kind == "motion" && words.size() > 2) {
    show.motion = words[2];
    show.motion_pattern = PatternIn(words, 3);
  } else if (kind == "speech") {
    std::string text;
    for (std::size_t i = 2; i < words.size(); ++i) text += words[i] + " ";
    const auto speech = vm::ParsePhonemes(text.empty() ? program.ui.say : text);
    if (!speech) return std::unexpected(speech.error());
    show.speech = *speech;
  } else {
    return Fail(
        Errc::kSyntax,
        "play expression NAME [N], play motion KIND [N] or play speech [PHONEMES] expected");
  }
  return Done(program.ui.player.Start(show, program.ui.loop, program.ui.now));
}

Answer Choose(Program& program, const LineWords& words) {
  Ui& ui = program.ui;
  const std::string kind = words.size() > 2 ? words[1] : "";
  if (kind == "expression") {
    ui.expression = words[2];
    ui.pattern = PatternIn(words, 3);
  } else if (kind == "mouth" || kind == "mouth28") {
    ui.bilingual = kind == "mouth28";
    ui.shape = words[2];
  } else if (kind == "motion" && ui.editor.state().curves.contains(words[2])) {
    ui.motion = words[2];
    ui.motion_pattern = PatternIn(words, 3);
    if (words.size() > 4) ui.scrub_ms = static_cast<float>(PatternIn(words, 4));
  } else if (const auto unit =
                 fsm::ParseUnitName(words.size() > 2 ? words[2] : "", ui.editor.unit_names());
             kind == "unit" && unit) {
    ui.field_unit = unit->number;
    ui.field_sides = unit->sides;
    if (words.size() > 3)
      ui.field_percent = static_cast<float>(std::clamp(PatternIn(words, 3), 0, 200));
  } else {
    return Fail(Errc::kSyntax,
                "choose expression NAME [N], mouth NAME, mouth28 NAME, motion KIND [N [MS]] or "
                "unit UNIT[L|R] [PERCENT] expected");
  }
  return "";
}

/// Where a point of the photo or a widget is in the window.
vm::Result<ImVec2> Place(const Program& program, const LineWords& words) {
  std::string label;
  for (std::size_t i = 1; i < words.size(); ++i) label += (i > 1 ? " " : "") + words[i];
  const auto mark = program.ui.marks.find(label);
  if (mark != program.ui.marks.end()) return mark->second;
  const auto points = PointsNamed(label);
  if (points && points->size() == 1 && program.ui.page == Page::kPoints) {
    const auto at = program.ui.editor.state().points.find(*points->begin());
    if (at != program.ui.editor.state().points.end()) {
      const glm::vec2 there = program.ui.view.ToWindow(glm::vec2(at->second));
      return ImVec2(there.x, there.y);
    }
  }
  return Fail(Errc::kBadValue, "'" + label + "' is neither a widget nor a point that is shown");
}

Answer Click(Program& program, const LineWords& words) {
  const auto at = Place(program, words);
  if (!at) return std::unexpected(at.error());
  ClickAt(program, *at);
  return "";
}

Answer View(Program& program, const LineWords& words) {
  const bool zoom = words[0] == "zoom";
  const auto v = Numbers(words, 1, zoom ? 1 : 2);
  if (!v) return std::unexpected(v.error());
  if (zoom) {
    if ((*v)[0] < 0 || (*v)[0] > 60) return Fail(Errc::kBadValue, "0 (fit) to 60 expected");
    program.ui.view.zoom = (*v)[0];
  } else if (words[0] == "turn") {
    program.ui.stage.turn = {(*v)[0], (*v)[1]};
  } else {
    program.ui.view.centre = {(*v)[0], (*v)[1]};
  }
  return "";
}

Answer Wait(Program& program, const LineWords& words) {
  if (words.size() == 1) {
    static_cast<void>(program.settle());  // the bottom line tells
    return "";
  }
  const auto ms = Numbers(words, 1, 1);
  if (!ms) return std::unexpected(ms.error());
  if ((*ms)[0] < 0 || (*ms)[0] > 600000) return Fail(Errc::kBadValue, "0 to 600000 ms expected");
  program.pass(vm::Time(static_cast<std::int64_t>((*ms)[0] * 1000)));
  return "";
}

Answer RunWindowCommand(Program& program, const LineWords& words) {
  const std::string& name = words[0];
  Ui& ui = program.ui;
  if (name == "page") return Turn(program, words);
  if (name == "play") return Play(program, words);
  if (name == "choose") return Choose(program, words);
  if (name == "mouse") return MoveMouse(program, words);
  if (name == "click") return Click(program, words);
  if (name == "zoom" || name == "centre" || name == "turn") return View(program, words);
  if (name == "wait") return Wait(program, words);
  if (name == "stop") {
    ui.player.Stop();
    return "";
  }
  if (name == "where") {
    const auto at = Place(program, words);
    if (!at) return std::unexpected(at.error());
    return fmt::format("{:.1f} {:.1f}", at->x, at->y);
  }
  if (name == "message") return ui.message;
  if (name == "head" && (words.size() == 2 || words.size() == 3)) {
    if (!IsHeadFile(words[1])) {
      return Fail(Errc::kBadValue,
                  "'" + words[1] + "' is no head's name: .obj, .glb, .gltf, .vrm or .txt expected");
    }
    auto opened = OpenFile(ui, words[1], words.size() == 3 ? words[2] : "");
    if (opened) opened = program.settle();
    return Done(opened);
  }
  if (name == "key" && words.size() == 2) {
    ui.window.key = words[1];
    Draw(program, 3);
    return "";
  }
  if (name == "type" && words.size() == 2) {
    ui.window.typed = words[1];
    Draw(program, 2);
    return "";
  }
  if (name == "screenshot" && words.size() == 2) return Done(program.frame(words[1]));
  if (name == "close") {
    ui.window.RequestClose(true);
    Draw(program, 3);
    return "";
  }
  if (name == "quit") {
    program.quit = true;
    return "";
  }
  return Fail(Errc::kUnknownCommand, "'" + name.substr(0, 40) + "' is no command, or something " +
                                         "must follow it; docs/face_editor.md lists them");
}

}  // namespace

vm::Result<std::string> RunLine(Program& program, const std::string& line) {
  const auto words = CommandWords(line);
  if (!words) return std::unexpected(words.error());
  if (words->empty()) return "";
  auto answer = RunCommand(program.ui.editor, *words);
  if (!answer) {
    auto done = RunWindowCommand(program, *words);
    program.ui.Check(done);
    return done;
  }
  if (program.ui.Check(*answer) && !(*answer)->empty() && (*words)[0] != "get") {
    program.ui.Tell(**answer);
  }
  if ((*words)[0] == "open" && *answer) {
    program.ui.photo_path = program.ui.editor.work()->path;
    program.ui.Tell(program.ui.editor.work()->notice);
  }
  Draw(program, 2);
  return *answer;
}

}  // namespace editor
