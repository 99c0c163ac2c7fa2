#include <algorithm>
#include <charconv>

#include "task_manager/grammar/compiler.h"
#include "task_manager/grammar/text.h"
#include "vm_protocol/core/charset.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/utf8.h"
#include "vm_protocol/xml/parser.h"

namespace vxml::srgs {
namespace {

bool ReadCount(std::string_view text, int& value) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && read.ptr == text.data() + text.size() && value >= 0 &&
         value <= kMaxRepeat;
}

}  // namespace

std::optional<Form> FormOfType(std::string_view type) {
  type = vm::xml::Trim(type.substr(0, type.find(';')));
  for (const std::string_view abnf :
       {"application/srgs", "application/grammar", "application/x-abnf"}) {
    if (type == abnf) return Form::kAbnf;
  }
  for (const std::string_view xml :
       {"application/srgs+xml", "application/grammar+xml", "text/xml", "application/xml"}) {
    if (type == xml) return Form::kXml;
  }
  return {};
}

bool ParseWeight(std::string_view text, double& value) {
  text = vm::xml::Trim(text);
  if (text.empty() || text.find_first_not_of("0123456789.") != std::string_view::npos) return false;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc()) return false;
  return read.ptr == text.data() + text.size();
}

bool IsRuleName(std::string_view name) {
  if (name.empty() || (name[0] >= '0' && name[0] <= '9')) return false;
  for (const char c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
                        (c >= '0' && c <= '9') || (c & 0x80) != 0;
    if (!letter) return false;
  }
  return true;
}

bool IsSpecialRule(std::string_view name) {
  return name == "NULL" || name == "VOID" || name == "GARBAGE";
}

bool IsLanguage(std::string_view text) {
  bool first = true;
  while (true) {
    const std::size_t end = std::min(text.find('-'), text.size());
    if (end == 0 || end > 8) return false;
    for (const char c : text.substr(0, end)) {
      const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
      if (!letter && (first || c < '0' || c > '9')) return false;
    }
    if (end == text.size()) return true;
    text.remove_prefix(end + 1);
    first = false;
  }
}

std::unique_ptr<Grammar> MakeGrammar(const GrammarContext& context) {
  auto grammar = std::make_unique<Grammar>();
  grammar->uri = context.uri;
  grammar->language = context.alone ? "" : context.language;
  grammar->mode = context.mode;
  grammar->alone = context.alone;
  return grammar;
}

vm::Result<void> CheckHeader(Grammar& grammar, const GrammarContext& context) {
  if (!grammar.root.empty() && !grammar.Find(grammar.root)) {
    return vm::Fail(vm::Errc::kSyntax, "root rule '" + grammar.root + "' is not defined");
  }
  if (context.alone && grammar.mode == Mode::kVoice && grammar.language.empty()) {
    return vm::Fail(vm::Errc::kSyntax, "a voice grammar has to declare its language");
  }
  if (!context.alone && grammar.root.empty() && grammar.rules.size() == 1) {
    grammar.root = grammar.rules.begin()->first;
  }
  return {};
}

namespace {

/// "1 star" -> "1 *"
std::string KeysNamed(const std::string& text) {
  std::string keys;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view word = rest.substr(0, rest.find(' '));
    rest.remove_prefix(std::min(word.size() + 1, rest.size()));
    if (!keys.empty()) keys += ' ';
    const std::string key = FoldKeys(Fold(word));
    keys += key == "*" || key == "#" ? key : word;
  }
  return keys;
}

bool CheckKeys(Expansion& node, std::string& wrong) {
  if (node.kind == Expansion::Kind::kToken) {
    node.folded = FoldKeys(node.folded);
    node.text = KeysNamed(node.text);
    if (node.folded.find_first_not_of("0123456789*#abcd") != std::string::npos) {
      wrong = node.text;
      return false;
    }
  }
  for (auto& child : node.children) {
    if (!CheckKeys(*child, wrong)) return false;
  }
  return true;
}

}  // namespace

vm::Result<void> CheckTokens(Grammar& grammar) {
  if (grammar.mode != Mode::kDtmf) return {};
  for (auto& [name, rule] : grammar.rules) {
    std::string wrong;
    if (rule->expansion && !CheckKeys(*rule->expansion, wrong)) {
      return vm::Fail(vm::Errc::kSyntax, "'" + wrong + "' is no key (0-9 * # A-D)");
    }
  }
  return {};
}

namespace {

bool HoldsOnlyTags(const Expansion& node) {
  return node.kind == Expansion::Kind::kTag ||
         (node.kind == Expansion::Kind::kSequence && !node.children.empty() &&
          std::ranges::all_of(node.children, [](const auto& it) { return HoldsOnlyTags(*it); }));
}

}  // namespace

std::unique_ptr<Expansion> MakeRepeat(std::unique_ptr<Expansion> what) {
  auto repeat = std::make_unique<Expansion>();
  repeat->kind = Expansion::Kind::kRepeat;
  repeat->children.push_back(std::move(what));
  return repeat;
}

void SetTurns(Expansion& repeat, int min, int max) {
  if (HoldsOnlyTags(*repeat.children[0])) {
    min = std::min(min, 1);
    max = max == 0 ? 0 : 1;
  }
  repeat.min = min;
  repeat.max = max;
}

bool ParseRepeat(std::string_view text, Expansion& repeat) {
  const std::size_t dash = text.find('-');
  int min = 0;
  if (!ReadCount(text.substr(0, dash), min)) return false;
  int max = min;
  if (dash != std::string_view::npos) {
    const std::string_view rest = text.substr(dash + 1);
    max = Expansion::kUnbounded;
    if (!rest.empty() && (!ReadCount(rest, max) || max < min)) return false;
  }
  SetTurns(repeat, min, max);
  return true;
}

vm::Result<void> ParseRepeatOperator(std::string_view inside, Expansion& repeat) {
  const std::string given(inside);
  if (const std::size_t slash = inside.find('/'); slash != std::string_view::npos) {
    std::string_view chance = vm::xml::Trim(inside.substr(slash + 1));
    double value = 0;
    if (!chance.ends_with('/')) {
      return vm::Fail(vm::Errc::kSyntax, "'/' expected after the probability");
    }
    chance.remove_suffix(1);
    if (!ParseWeight(chance, value) || value > 1) {
      return vm::Fail(vm::Errc::kSyntax, "a probability of 0 to 1 expected");
    }
    inside = inside.substr(0, slash);
  }
  if (!ParseRepeat(vm::xml::Trim(inside), repeat)) {
    return vm::Fail(
        vm::Errc::kSyntax,
        "repeat <" + given + ">, expected <N>, <N-M> or <N-> up to " + std::to_string(kMaxRepeat));
  }
  return {};
}

std::unique_ptr<Expansion> MakeToken(std::string_view text) {
  auto token = std::make_unique<Expansion>();
  token->kind = Expansion::Kind::kToken;
  token->text = vm::xml::Collapse(text);
  token->folded = Fold(token->text);
  return token;
}

void SplitReference(const std::string& reference, Expansion& into) {
  const std::size_t hash = reference.find('#');
  into.text = reference;
  into.uri = reference.substr(0, hash);
  into.rule = hash == std::string::npos ? "" : reference.substr(hash + 1);
}

vm::Result<std::unique_ptr<Grammar>> CompileBytes(std::string_view bytes,
                                                  const GrammarContext& context,
                                                  const std::string& charset) {
  if (bytes.size() > kMaxGrammarBytes) {
    return vm::Fail(vm::Errc::kTooLong,
                    context.uri + ": over " + std::to_string(kMaxGrammarBytes) + " bytes");
  }
  std::string decoded;
  std::string_view start = bytes;
  const bool utf16 = bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff");
  if (utf16) {
    auto utf8 = vm::DecodeCharset(bytes, "UTF-16");
    if (!utf8) return vm::Fail(utf8.error().code, context.uri + ":1:1: " + utf8.error().text);
    start = decoded = std::move(*utf8);
  }
  if (start.starts_with("\xef\xbb\xbf")) start.remove_prefix(3);
  const std::string_view unmarked = start;
  start = vm::xml::Trim(start);
  if (!start.starts_with("<")) {
    if (!start.starts_with("#ABNF") || (context.alone && !unmarked.starts_with("#ABNF"))) {
      return vm::Fail(vm::Errc::kSyntax, context.uri + ":1:1: neither XML nor '#ABNF 1.0'");
    }
    std::string text(start);
    std::string encoding = charset;
    const std::string header = vm::xml::Collapse(start.substr(0, start.find(';')));
    const std::size_t blank = header.find(' ', 6);  // #ABNF 1.0 ISO-8859-1;
    if (blank != std::string::npos) encoding = header.substr(blank + 1);
    encoding = vm::LowerCase(encoding);
    if (!utf16 && !encoding.empty() && encoding != "utf-8") {
      auto utf8 = vm::DecodeCharset(start, encoding);
      if (!utf8) return vm::Fail(utf8.error().code, context.uri + ":1:1: " + utf8.error().text);
      text = std::move(*utf8);
    }
    if (const auto bad = vm::FirstBadUtf8(text)) {
      const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(*bad), '\n');
      return vm::Fail(vm::Errc::kBadUtf8, context.uri + ":" + std::to_string(line) +
                                              ":1: bytes that are no UTF-8 (the header names "
                                              "another encoding: #ABNF 1.0 ISO-8859-1;)");
    }
    return CompileAbnf(text, context);
  }
  vm::xml::Limits limits;
  limits.document_bytes = kMaxGrammarBytes;
  limits.depth = kMaxGrammarDepth;
  auto document = vm::xml::Parse(bytes, context.uri, charset, limits);
  if (!document) return std::unexpected(document.error());
  if (!document->root->IsElement("grammar")) {
    return vm::Fail(vm::Errc::kSyntax, context.uri + ":" + std::to_string(document->root->line) +
                                           ":1: found <" + document->root->name +
                                           ">, expected <grammar>");
  }
  return CompileXml(*document->root, context);
}

}  // namespace vxml::srgs
