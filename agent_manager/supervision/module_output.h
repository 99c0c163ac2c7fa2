#pragma once

#include <deque>
#include <string>
#include <string_view>

namespace am {

/// A line of a module's stderr.
struct OutputLine {
  std::string level;  ///< ERROR, WARNING or INFO
  std::string text;
};

/// Tells the level from the first words: "fsm: error: no display" is an ERROR, as is the name of an
/// exception, "ValueError: ..."; a line without such a word is INFO.
OutputLine ParseOutputLine(std::string text);

/// The last kMaxOutputLines lines of one module's stderr, oldest first.
class ModuleOutput {
 public:
  static constexpr std::size_t kMaxOutputLines = 200;
  void Add(OutputLine line) {
    lines_.push_back(std::move(line));
    if (lines_.size() > kMaxOutputLines) lines_.pop_front();
  }
  /// The program has failed, and `text` is the last it said: its line becomes an ERROR.
  void BlameLast(const std::string& text) {
    if (!lines_.empty() && lines_.back().text == text) lines_.back().level = "ERROR";
  }
  const std::deque<OutputLine>& lines() const { return lines_; }

 private:
  std::deque<OutputLine> lines_;
};

}  // namespace am
