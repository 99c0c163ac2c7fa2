#include "chat/rules/rules.h"

#include <algorithm>

#include "chat/text/table_lines.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/utf8.h"

namespace chat {
namespace {

using vm::Errc;
using vm::Fail;

constexpr std::u32string_view kBetweenClauses = U".?!;:,。？！、，．…\n\"“”()（）「」";

bool IsLetter(char32_t sign) {
  return sign > 0x7F || (sign >= U'a' && sign <= U'z') || (sign >= U'A' && sign <= U'Z') ||
         (sign >= U'0' && sign <= U'9') || sign == U'\'';
}

/// Signs of full width become plain ones, curly apostrophes straight.
char32_t Plain(char32_t sign) {
  if (sign >= 0xFF01 && sign <= 0xFF5E && sign != U'？' && sign != U'！' && sign != U'，') {
    sign -= 0xFEE0;
  }
  return sign == U'’' ? U'\'' : sign == U'　' ? U' ' : sign;
}

std::string Capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 32);
  return text;
}

std::string TimeText(const std::tm& now, bool english) {
  if (!english) return std::to_string(now.tm_hour) + "時" + std::to_string(now.tm_min) + "分";
  const int hour = now.tm_hour % 12 == 0 ? 12 : now.tm_hour % 12;
  const std::string minute = (now.tm_min < 10 ? "0" : "") + std::to_string(now.tm_min);
  return std::to_string(hour) + ":" + minute + (now.tm_hour < 12 ? " a.m" : " p.m");
}

std::string DateText(const std::tm& now, bool english) {
  static constexpr const char* kMonths[] = {"January",   "February", "March",    "April",
                                            "May",       "June",     "July",     "August",
                                            "September", "October",  "November", "December"};
  if (!english) return std::to_string(now.tm_mon + 1) + "月" + std::to_string(now.tm_mday) + "日";
  return std::string(kMonths[std::clamp(now.tm_mon, 0, 11)]) + " " + std::to_string(now.tm_mday);
}

std::string WeekdayText(const std::tm& now, bool english) {
  static constexpr const char* kEnglish[] = {"Sunday",   "Monday", "Tuesday", "Wednesday",
                                             "Thursday", "Friday", "Saturday"};
  static constexpr const char* kJapanese[] = {"日曜日", "月曜日", "火曜日", "水曜日",
                                              "木曜日", "金曜日", "土曜日"};
  const int day = std::clamp(now.tm_wday, 0, 6);
  return english ? kEnglish[day] : kJapanese[day];
}

/// The name of the variable after the $ at `at`: letters, or one digit.
std::string VariableAt(const std::string& text, std::size_t at) {
  std::size_t end = at + 1;
  if (end < text.size() && text[end] >= '0' && text[end] <= '9') return text.substr(end, 1);
  while (end < text.size() && text[end] >= 'a' && text[end] <= 'z') ++end;
  return text.substr(at + 1, end - at - 1);
}

}  // namespace

/// A language whose words are not parted is matched sign by sign.
Rules::Pattern Rules::PatternOf(std::string_view text) const {
  Pattern pattern;
  if (text.starts_with('^')) pattern.from_start = true;
  if (text.ends_with('$')) pattern.to_end = true;
  text.remove_prefix(pattern.from_start ? 1 : 0);
  text.remove_suffix(pattern.to_end ? 1 : 0);
  for (const std::string_view word : SplitAt(text, " \t")) {
    if (spaced_ || word == "*") {
      Element element{.any = word == "*", .words = {}};
      for (const std::string_view one : SplitAt(word, "/"))
        element.words.push_back(vm::LowerCase(one));
      pattern.elements.push_back(std::move(element));
      continue;
    }
    for (const char32_t sign : vm::SignsOf(word)) {
      Element element{.any = sign == U'*', .words = {}};
      element.words.push_back(vm::LowerCase(vm::Utf8Of(std::u32string_view(&sign, 1))));
      pattern.elements.push_back(std::move(element));
    }
  }
  return pattern;
}

vm::Result<void> Rules::AddLine(std::string_view line) {
  const std::size_t blank = std::min(line.find_first_of(" \t"), line.size());
  const std::string_view word = line.substr(0, blank);
  const std::string_view rest = vm::Trimmed(line.substr(blank));
  if (rest.empty()) return Fail(Errc::kSyntax, "nothing behind '" + std::string(word) + "'");
  if (word == "language") {
    language_ = rest;
    spaced_ = language_ != "ja";
  } else if (word == "reflect") {
    const std::size_t end = rest.find_first_of(" \t");
    if (end == std::string_view::npos) return Fail(Errc::kSyntax, "expected reflect WORD WORDS");
    reflections_[std::string(rest.substr(0, end))] = vm::Trimmed(rest.substr(end));
  } else if (word == "hear") {
    // Further patterns of a rule that has no answers yet, or a new one.
    if (rules_.empty() || !rules_.back().answers.empty()) rules_.emplace_back();
    for (const std::string_view pattern : SplitAt(rest, "|"))
      rules_.back().patterns.push_back(PatternOf(pattern));
  } else if ((word == "say" || word == "keep") && rules_.empty()) {
    return Fail(Errc::kSyntax, "'" + std::string(word) + "' without 'hear' before it");
  } else if (word == "say") {
    rules_.back().answers.emplace_back(rest);
  } else if (word == "keep") {
    const std::size_t end = rest.find_first_of(" \t");
    if (end == std::string_view::npos) return Fail(Errc::kSyntax, "expected keep NAME VALUE");
    rules_.back().keeps.emplace_back(rest.substr(0, end), vm::Trimmed(rest.substr(end)));
  } else {
    return Fail(Errc::kSyntax,
                "found '" + std::string(word) + "', expected language, reflect, hear, keep or say");
  }
  return {};
}

vm::Result<Rules> Rules::Parse(const std::string& file, std::string_view text) {
  Rules rules;
  for (const TableLine& line : TableLines(text)) {
    if (const auto added = rules.AddLine(line.text); !added)
      return Fail(added.error().code, Place(file, line.number) + added.error().text);
  }
  for (const Rule& rule : rules.rules_) {
    if (rule.answers.empty()) return Fail(Errc::kBadValue, file + ": a rule without an answer");
  }
  return rules;
}

void Rules::Forget() {
  kept_.clear();
  for (Rule& rule : rules_) rule.next = 0;
}

std::vector<Rules::Tokens> Rules::Clauses(std::string_view heard) const {
  std::vector<Tokens> clauses(1);
  std::string word;
  std::size_t count = 0;
  const auto end_word = [&] {
    if (word.empty() || count >= kMaxTokens) return word.clear();
    ++count;
    clauses.back().push_back({vm::LowerCase(word), word});
    word.clear();
  };
  for (char32_t sign : vm::SignsOf(heard)) {
    sign = Plain(sign);
    if (kBetweenClauses.contains(sign)) {
      end_word();
      if (!clauses.back().empty()) clauses.emplace_back();
    } else if (!IsLetter(sign)) {
      end_word();
    } else {
      vm::AppendUtf8(word, sign);
      if (!spaced_) end_word();
    }
  }
  end_word();
  if (clauses.back().empty() && clauses.size() > 1) clauses.pop_back();
  return clauses;
}

/// `ranges`: what each star has taken.
bool Rules::MatchFrom(const Pattern& pattern, std::size_t element, const Tokens& tokens,
                      std::size_t at,
                      std::vector<std::pair<std::size_t, std::size_t>>& ranges) const {
  if (element == pattern.elements.size()) return !pattern.to_end || at == tokens.size();
  const Element& wanted = pattern.elements[element];
  if (!wanted.any) {
    return at < tokens.size() &&
           std::ranges::find(wanted.words, tokens[at].word) != wanted.words.end() &&
           MatchFrom(pattern, element + 1, tokens, at + 1, ranges);
  }
  const bool last = element + 1 == pattern.elements.size();
  for (std::size_t end = last ? tokens.size() : at; end <= tokens.size(); ++end) {
    ranges.emplace_back(at, end);
    if (MatchFrom(pattern, element + 1, tokens, end, ranges)) return true;
    ranges.pop_back();
  }
  return false;
}

std::optional<Rules::Captures> Rules::Match(const Pattern& pattern, const Tokens& tokens) const {
  for (std::size_t from = 0; from <= (pattern.from_start ? 0 : tokens.size()); ++from) {
    std::vector<std::pair<std::size_t, std::size_t>> ranges;
    if (!MatchFrom(pattern, 0, tokens, from, ranges)) continue;
    Captures captures;
    for (const auto& [begin, end] : ranges) captures.push_back(Reflected(tokens, begin, end));
    return captures;
  }
  return {};
}

/// My and your change places.
std::string Rules::Reflected(const Tokens& tokens, std::size_t begin, std::size_t end) const {
  std::string text;
  for (std::size_t i = begin; i < end; ++i) {
    const auto reflected = reflections_.find(tokens[i].word);
    if (!text.empty() && spaced_) text += ' ';
    text += reflected == reflections_.end() ? tokens[i].written : reflected->second;
  }
  return text;
}

/// None if a variable has no value.
std::optional<std::string> Rules::Filled(const std::string& answer, const Variables& variables) {
  std::string filled;
  for (std::size_t at = 0; at < answer.size();) {
    const std::size_t dollar = std::min(answer.find('$', at), answer.size());
    filled += answer.substr(at, dollar - at);
    if (dollar == answer.size()) break;
    const std::string name = VariableAt(answer, dollar);
    const auto found = variables.find(name);
    if (found == variables.end() || found->second.empty()) return {};
    filled += found->second;
    at = dollar + 1 + name.size();
  }
  return filled;
}

std::string Rules::AnswerOf(Rule& rule, Variables variables) {
  for (const auto& [name, value] : rule.keeps) {
    if (const auto filled = Filled(value, variables)) {
      variables[name] = kept_[name] = spaced_ ? Capitalised(*filled) : *filled;
    }
  }
  for (std::size_t tried = 0; tried < rule.answers.size(); ++tried) {
    const std::string& answer = rule.answers[rule.next++ % rule.answers.size()];
    if (auto filled = Filled(answer, variables)) return *filled;
  }
  return "";
}

std::string Rules::Answer(std::string_view heard, const std::string& agent, const std::tm& now) {
  const auto clauses = Clauses(heard);
  Variables known = kept_;
  known["agent"] = agent;
  known["time"] = TimeText(now, spaced_);
  known["date"] = DateText(now, spaced_);
  known["weekday"] = WeekdayText(now, spaced_);
  for (Rule& rule : rules_) {
    for (const Pattern& pattern : rule.patterns) {
      for (const Tokens& clause : clauses) {
        const auto captures = Match(pattern, clause);
        if (!captures) continue;
        Variables variables = known;
        for (std::size_t i = 0; i < captures->size(); ++i)
          variables[std::to_string(i + 1)] = (*captures)[i];
        if (std::string answer = AnswerOf(rule, variables); !answer.empty()) return answer;
      }
    }
  }
  return "";
}

}  // namespace chat
