#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vxml {

/// The subtitles of a dialogue's film, from the lines of its transcript (docs/dialogs.md): what the
/// agent says while it says it, and below in italics what the user said. At most two lines of 42
/// columns are shown at once (a kana or kanji takes two); what is longer follows in parts, each for
/// as long as its share of the words. Thread: one. Limit: kMostCues, later ones are left out.
class Subtitles {
 public:
  static constexpr std::size_t kMostCues = 100'000;

  /// A line of the transcript; other lines than prompts and results say nothing.
  void Add(const std::string& json_line);
  std::string Srt() const;
  std::string Vtt() const;
  /// Writes FILM.srt and FILM.vtt beside FILM.mp4. Error: kUnavailable naming the file.
  vm::Result<void> WriteBeside(const std::string& film) const;

 private:
  using Millis = std::chrono::milliseconds;
  struct Cue {
    Millis begin{0}, end{0};
    bool user = false;
    std::string text;  ///< one or two lines
  };
  void AddCues(Millis begin, Millis length, bool user, const std::string& text);

  std::vector<Cue> cues_;
};

}  // namespace vxml
