#include <utility>

#include "task_manager/grammar/matcher.h"
#include "task_manager/grammar/text.h"

namespace vxml::srgs {
namespace {

std::string Quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace

std::string Parse::Text() const {
  std::string text;
  const bool dtmf = rule && rule->grammar && rule->grammar->mode == Mode::kDtmf;
  for (const ParseItem& item : items) {
    const std::string part = item.kind == ParseItem::Kind::kRule  ? item.rule->Text()
                             : item.kind == ParseItem::Kind::kTag ? ""
                                                                  : item.text;
    if (part.empty()) continue;
    const bool joined =
        !dtmf && !text.empty() &&
        (!IsUnspaced(DecodeBefore(text, text.size())) || !IsUnspaced(vm::SignAt(part, 0).value));
    if (joined) text += ' ';
    text += part;
  }
  return text;
}

std::string Parse::Format() const {
  std::string out = "$" + name + "[";
  bool first = true;
  for (const ParseItem& item : items) {
    if (!std::exchange(first, false)) out += ", ";
    switch (item.kind) {
      case ParseItem::Kind::kToken:
        out += Quote(item.text);
        break;
      case ParseItem::Kind::kTag:
        out += "{" + item.text + "}";
        break;
      case ParseItem::Kind::kRule:
        out += item.rule->Format();
        break;
      case ParseItem::Kind::kGarbage:
        out += "$GARBAGE[" + Quote(item.text) + "]";
        break;
    }
  }
  return out + "]";
}

}  // namespace vxml::srgs
