// What the face does in prompts: feelings, BML's behaviours, raw commands.
#include <algorithm>
#include <charconv>

#include "task_manager/document/values.h"
#include "task_manager/interpreter/prompt_builder.h"
#include "task_manager/interpreter/prompt_writer.h"

namespace vxml {
namespace {

constexpr double kLongestSleep = 600;  ///< seconds

}  // namespace

/// NEUTRAL for names that no table knows, or error.unsupported.emotion if the markup is strict.
Feeling PromptBuilder::FeelingOf(const vm::xml::Node& emotion) const {
  if (const auto feeling = ReadFeeling(emotion)) return *feeling;
  if (rt_.options.strict_markup) {
    ThrowEvent("error.unsupported.emotion", "emotion '" + emotion.Get("type") + "' is not known");
  }
  rt_.Warn("unknown emotion, NEUTRAL is shown", emotion.line);
  return {};
}

/// A feeling for the time of the words inside; afterwards the one around it.
void PromptBuilder::Emotion(const vm::xml::Node& node) {
  const Feeling feeling = FeelingOf(node);
  if (feeling.on_face) Command(FaceCommand(feeling), Millis(0), false);
  feelings_.push_back(feeling);
  AddChildren(node);
  EndWords();
  feelings_.pop_back();
  if (!feeling.on_face) return;
  const auto around = std::find_if(feelings_.rbegin(), feelings_.rend(),
                                   [](const Feeling& it) { return it.on_face; });
  Command(FaceCommand(around == feelings_.rend() ? Feeling{} : *around), Millis(0), false);
}

/// <media type="face">: commands and sleeps beside the words (the original's PAR).
void PromptBuilder::Media(const vm::xml::Node& node) {
  if (node.Get("type") != "face") return AddChildren(node);
  Millis wait(0);
  for (const auto& child : node.children) {
    if (!child->IsElement()) continue;
    std::vector<std::string> lines;
    if (child->name == "native") {
      lines = NativeLines(rt_, *child);
    } else if (child->name == "emotion") {
      lines.push_back(FaceCommand(FeelingOf(*child)));
    } else {
      lines = BehaviourCommands(*child);
    }
    for (const std::string& line : lines) {
      if (child->name == "native" && line.starts_with("sleep ")) {
        const double seconds = NumberIn(line.substr(6), 0, kLongestSleep, 0);
        wait += Millis(static_cast<long long>(seconds * 1000));
        continue;
      }
      EndWords();
      // Parallel commands come before the words they run beside.
      prompt_.segments.push_back(
          {Segment::Kind::kCommand, line, std::exchange(wait, Millis(0)), "", true, ""});
    }
  }
}

/// A behaviour runs where it stands, or where its start="ID:POINT+SECONDS" says (BML 1.0).
void PromptBuilder::Behaviour(const vm::xml::Node& node) {
  const std::string start(vm::xml::Trim(node.Get("start")));
  for (const std::string& line : BehaviourCommands(node)) {
    if (start.empty()) {
      Command(line, Millis(0), false);
    } else {
      EndWords();
      deferred_.push_back({start, line, prompt_.segments.size(), node.line});
    }
  }
  if (node.name != "faceShift") AddChildren(node);
}

void PromptBuilder::Anchor(const std::string& name) {
  EndWords();
  anchors_.emplace(name, prompt_.segments.size());
}

/// Puts the behaviours that refer to a point behind it. A reference to nothing is warned of, and
/// the behaviour runs where it stands.
void PromptBuilder::PlaceDeferred() {
  struct Placed {
    std::size_t at;
    Segment segment;
  };
  std::vector<Placed> placed;
  for (const Deferred& each : deferred_) {
    const std::size_t sign = each.start.find_first_of("+-", 1);
    const std::string point = each.start.substr(0, sign);
    double seconds = 0;
    const auto number = [&](std::string_view text) {
      return std::from_chars(text.data(), text.data() + text.size(), seconds).ec == std::errc();
    };
    std::size_t at = each.at;
    if (const auto found = anchors_.find(point); found != anchors_.end()) {
      at = found->second;
      // Before a point nothing can be sent that is not known yet: minus means at the point.
      if (sign != std::string::npos && each.start[sign] == '+') {
        number(std::string_view(each.start).substr(sign + 1));
      }
    } else if (number(each.start)) {
      at = 0;  // seconds from the beginning of the prompt
    } else {
      rt_.Warn("start '" + each.start + "' refers to nothing in the prompt", each.line);
    }
    const Millis wait(static_cast<long long>(std::clamp(seconds, 0.0, 600.0) * 1000));
    placed.push_back({at, {Segment::Kind::kCommand, each.command, wait, "", false, ""}});
  }
  // From the last place to the first, so that the earlier ones stay what they are.
  while (!placed.empty()) {
    auto last = placed.begin();
    for (auto each = placed.begin(); each != placed.end(); ++each) {
      if (each->at >= last->at) last = each;
    }
    prompt_.segments.insert(prompt_.segments.begin() + static_cast<std::ptrdiff_t>(last->at),
                            last->segment);
    placed.erase(last);
  }
}

}  // namespace vxml
