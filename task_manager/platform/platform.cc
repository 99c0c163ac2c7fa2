#include "task_manager/platform/platform.h"

#include <algorithm>

namespace vxml {

std::vector<std::string> Prompt::Feelings() const {
  constexpr std::string_view kShows = "to @FSM set FaceExp = ";
  std::vector<std::string> shown;
  for (const Segment& segment : segments) {
    if (segment.kind != Segment::Kind::kCommand || !segment.text.starts_with(kShows)) continue;
    const std::string rest = segment.text.substr(kShows.size());
    std::string feeling = rest.substr(0, rest.find(' '));
    if (feeling != "NEUTRAL" && std::ranges::find(shown, feeling) == shown.end()) {
      shown.push_back(std::move(feeling));
    }
  }
  return shown;
}

bool Prompt::IsNative() const {
  return !timeout && !segments.empty() &&
         std::ranges::all_of(segments, [](const Segment& segment) { return segment.native; });
}

}  // namespace vxml
