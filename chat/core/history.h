#pragma once

#include <deque>
#include <string>
#include <string_view>

namespace chat {

/// What both said, as far as it was heard. Limits: the turns set, kMaxBytes of words; beyond them
/// the oldest are forgotten.
class History {
 public:
  static constexpr std::size_t kMaxBytes = 16 << 10;
  struct Entry {
    bool user = false;
    std::string text;
  };

  /// What the same side says without an answer between becomes one entry: models want the sides to
  /// take turns.
  void AddUser(std::string_view text) { Add(true, text); }
  void AddAgent(std::string_view text) { Add(false, text); }
  /// What the user said last is forgotten, unless the agent has answered it.
  void DropUnanswered();
  void Clear() { entries_.clear(); }
  /// A turn is what the user says with its answer.
  void set_turns(std::size_t turns);
  const std::deque<Entry>& entries() const { return entries_; }
  /// [{"role": "user", "content": "..."}, ...] on one line.
  std::string Json() const;

 private:
  void Add(bool user, std::string_view text);
  void Trim();

  std::size_t turns_ = 20;
  std::deque<Entry> entries_;
};

}  // namespace chat
