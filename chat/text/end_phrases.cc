#include "chat/text/end_phrases.h"

#include <algorithm>
#include <cctype>

#include "chat/text/table_lines.h"

namespace chat {
namespace {

bool IsWordByte(unsigned char c) { return c >= 0x80 || std::isalnum(c) != 0 || c == '\''; }

/// " words in small letters ", one blank before and behind each.
std::string Plain(std::string_view text) {
  std::string plain = " ";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (IsWordByte(byte)) {
      plain += byte < 0x80 ? static_cast<char>(std::tolower(byte)) : c;
    } else if (plain.back() != ' ') {
      plain += ' ';
    }
  }
  if (plain.back() != ' ') plain += ' ';
  return plain;
}

bool IsAscii(std::string_view text) {
  return std::ranges::all_of(text, [](unsigned char c) { return c < 0x80; });
}

}  // namespace

EndPhrases::EndPhrases(std::string_view text) {
  for (const std::string_view phrase : SplitAt(text, "|")) {
    std::string plain = Plain(phrase);
    if (plain == " " || phrases_.size() == kMaxPhrases) continue;
    if (!IsAscii(plain)) plain = plain.substr(1, plain.size() - 2);
    phrases_.push_back(std::move(plain));
  }
}

bool EndPhrases::FoundIn(std::string_view heard) const {
  const std::string plain = Plain(heard);
  return std::ranges::any_of(phrases_,
                             [&](const std::string& phrase) { return plain.contains(phrase); });
}

}  // namespace chat
