#include "chat/core/history.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "vm_protocol/core/utf8.h"

namespace chat {

void History::Add(bool user, std::string_view text) {
  text = vm::CutUtf8(text, kMaxBytes);
  if (text.empty()) return;
  if (!entries_.empty() && entries_.back().user == user) {
    entries_.back().text += "\n" + std::string(text);
  } else {
    entries_.push_back({user, std::string(text)});
  }
  Trim();
}

void History::DropUnanswered() {
  if (!entries_.empty() && entries_.back().user) entries_.pop_back();
}

void History::set_turns(std::size_t turns) {
  turns_ = turns;
  Trim();
}

void History::Trim() {
  const auto too_much = [this] {
    std::size_t bytes = 0;
    for (const Entry& entry : entries_) bytes += entry.text.size();
    const auto turns = std::ranges::count(entries_, true, &Entry::user);
    return bytes > kMaxBytes || static_cast<std::size_t>(turns) > turns_;
  };
  while (entries_.size() > 1 && too_much()) {
    entries_.pop_front();
    // A history begins with what the user says, unless the agent alone has spoken.
    if (entries_.size() > 1 && !entries_.front().user) entries_.pop_front();
  }
  if (!entries_.empty() && entries_.front().text.size() > kMaxBytes) {
    std::string& text = entries_.front().text;
    std::size_t begin = text.size() - kMaxBytes;
    while (begin < text.size() && !vm::BeginsSign(text[begin])) ++begin;
    text.erase(0, begin);
  }
}

std::string History::Json() const {
  auto list = nlohmann::json::array();
  for (const Entry& entry : entries_)
    list.push_back({{"role", entry.user ? "user" : "assistant"}, {"content", entry.text}});
  return list.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace chat
