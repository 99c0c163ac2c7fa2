#include "task_manager/app/subtitles.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "task_manager/app/readable.h"
#include "task_manager/grammar/text.h"
#include "vm_protocol/core/utf8.h"
#include "vm_protocol/xml/node.h"

namespace vxml {
namespace {

using Millis = std::chrono::milliseconds;

constexpr std::size_t kColumns = 42;
constexpr std::size_t kLines = 2;
constexpr Millis kShortest{1200};  // of what the user said, which has no length
constexpr Millis kPerColumn{60};

struct Line {
  std::string text;
  std::size_t columns = 0;
};

/// What is not parted at the end of a line: a word, or a kana or kanji with the stops behind it.
std::vector<Line> UnitsOf(const std::string& text) {
  static const std::u32string kStops = U"、。，．！？」』）…ー";
  std::vector<Line> units;
  bool joins = false;
  for (const char32_t sign : vm::SignsOf(text)) {
    const bool blank = sign <= U' ';
    const bool wide = srgs::IsUnspaced(sign) || sign >= 0x3000;
    const bool stop = kStops.find(sign) != std::u32string::npos;
    if (units.empty() || (!joins && !blank && !stop) || (wide && !stop)) units.push_back({});
    joins = !blank && !wide;
    if (blank && units.back().text.ends_with(' ')) continue;
    vm::AppendUtf8(units.back().text, blank ? U' ' : sign);
    units.back().columns += wide ? 2 : 1;
  }
  return units;
}

std::vector<Line> LinesOf(const std::string& text) {
  std::vector<Line> lines;
  for (const Line& unit : UnitsOf(text)) {
    if (lines.empty() || lines.back().columns + unit.columns > kColumns + 1) lines.push_back({});
    lines.back().text += unit.text;
    lines.back().columns += unit.columns;
  }
  for (Line& line : lines) {
    while (line.text.ends_with(' ')) line.text.pop_back();
  }
  std::erase_if(lines, [](const Line& line) { return line.text.empty(); });
  return lines;
}

std::string TimeText(Millis time, char point) {
  const long long ms = std::max<long long>(time.count(), 0);
  char text[60];
  std::snprintf(text, sizeof text, "%02lld:%02lld:%02lld%c%03lld", ms / 3'600'000, ms / 60'000 % 60,
                ms / 1000 % 60, point, ms % 1000);
  return text;
}

}  // namespace

void Subtitles::Add(const std::string& json_line) {
  const auto line = nlohmann::json::parse(json_line, nullptr, false);
  if (!line.is_object()) return;
  const auto number = [&](const char* name) {
    return Millis(static_cast<long long>(line.value(name, 0.0)));
  };
  const std::string type = line.value("type", "");
  if (type == "prompt") {
    AddCues(number("t"), number(line.contains("heard_ms") ? "heard_ms" : "ms"), false,
            line.value("text", ""));
  } else if (type == "result") {
    const std::string words = line.value("utterance", "");
    if (!IsUnknown(words)) AddCues(number("t"), Millis(0), true, words);
  }
}

void Subtitles::AddCues(Millis begin, Millis length, bool user, const std::string& text) {
  const auto lines = LinesOf(text);
  long long columns = 0, before = 0;
  for (const Line& line : lines) columns += static_cast<long long>(line.columns);
  if (user) {  // the time is that of the result: they began before, when the agent had ended
    length = std::max<Millis>(kShortest, kPerColumn * columns);
    begin = std::max(begin - length, cues_.empty() ? Millis(0) : std::min(begin, cues_.back().end));
  } else if (!cues_.empty()) {  // what the user said is shown no longer than they are the last
    cues_.back().end = std::min(cues_.back().end, std::max(begin, cues_.back().begin));
  }
  const auto at = [&] { return begin + length * before / columns; };
  for (std::size_t i = 0; i < lines.size() && cues_.size() < kMostCues; i += kLines) {
    Cue cue{.begin = at(), .end = {}, .user = user, .text = {}};
    for (std::size_t k = i; k < std::min(i + kLines, lines.size()); ++k) {
      cue.text += (k == i ? "" : "\n") + lines[k].text;
      before += static_cast<long long>(lines[k].columns);
    }
    cue.end = at();
    if (cue.end > cue.begin) cues_.push_back(std::move(cue));
  }
}

std::string Subtitles::Srt() const {
  std::string text;
  std::size_t number = 0;
  for (const Cue& cue : cues_) {
    text += std::to_string(++number) + "\n" + TimeText(cue.begin, ',') + " --> " +
            TimeText(cue.end, ',') + "\n";
    text += (cue.user ? "<i>" + cue.text + "</i>" : cue.text) + "\n\n";
  }
  return text;
}

std::string Subtitles::Vtt() const {
  std::string text = "WEBVTT\n\n";
  for (const Cue& cue : cues_) {
    const std::string words = vm::xml::Escape(cue.text);
    text += TimeText(cue.begin, '.') + " --> " + TimeText(cue.end, '.') + "\n";
    text += (cue.user ? "<v User><i>" + words + "</i>" : "<v Agent>" + words) + "\n\n";
  }
  return text;
}

vm::Result<void> Subtitles::WriteBeside(const std::string& film) const {
  const std::string stem = film.substr(0, film.rfind('.'));
  for (const auto& [ending, text] : {std::pair(".srt", Srt()), std::pair(".vtt", Vtt())}) {
    std::ofstream file(stem + ending, std::ios::binary);
    if (!(file << text).flush()) {
      return vm::Fail(vm::Errc::kUnavailable, "'" + stem + ending + "': cannot be written");
    }
  }
  return {};
}

}  // namespace vxml
