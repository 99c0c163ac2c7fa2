#include "task_manager/interpreter/phrase_grammar.h"

#include "task_manager/document/schema.h"
#include "task_manager/grammar/compiler.h"

namespace vxml {
namespace {

using srgs::Expansion;
using Parts = std::vector<std::unique_ptr<Expansion>>;

Parts TokensOf(const Phrase& phrase) {
  Parts tokens;
  if (phrase.dtmf) {
    for (const char c : phrase.words) {
      if (c != ' ' && c != '\t') tokens.push_back(srgs::MakeToken(std::string(1, c)));
    }
  } else {
    for (const std::string_view word : SplitWords(phrase.words)) {
      tokens.push_back(srgs::MakeToken(word));
    }
  }
  return tokens;
}

/// For each word: that one, and what follows it may be left out.
std::unique_ptr<Expansion> AnyOf(const Parts& tokens) {
  auto choice = std::make_unique<Expansion>();
  choice->kind = Expansion::Kind::kAlternatives;
  for (std::size_t first = 0; first < tokens.size(); ++first) {
    auto sequence = std::make_unique<Expansion>();
    sequence->children.push_back(srgs::MakeToken(tokens[first]->text));
    for (std::size_t next = first + 1; next < tokens.size(); ++next) {
      auto optional = std::make_unique<Expansion>();
      optional->kind = Expansion::Kind::kRepeat;
      optional->min = 0;
      optional->children.push_back(srgs::MakeToken(tokens[next]->text));
      sequence->children.push_back(std::move(optional));
    }
    choice->children.push_back(std::move(sequence));
  }
  return choice;
}

}  // namespace

std::string Phrase::Key() const {
  const std::string kind = dtmf ? "dtmf " : approximate ? "approx " : "exact ";
  return kind + words + (value ? " => " + *value : "");
}

std::unique_ptr<srgs::Grammar> MakeGrammar(const Phrase& phrase) {
  auto grammar = std::make_unique<srgs::Grammar>();
  grammar->uri = "platform:" + phrase.Key();
  grammar->mode = phrase.dtmf ? srgs::Mode::kDtmf : srgs::Mode::kVoice;
  grammar->root = "phrase";
  grammar->tag_format = "semantics/1.0-literals";
  auto rule = std::make_unique<srgs::Rule>();
  rule->name = grammar->root;
  rule->grammar = grammar.get();
  rule->is_public = true;
  rule->expansion = std::make_unique<Expansion>();
  auto& parts = rule->expansion->children;
  parts = TokensOf(phrase);
  if (phrase.approximate && parts.size() > 1 && parts.size() <= Phrase::kMostApproximate) {
    auto any = AnyOf(parts);
    parts.clear();
    parts.push_back(std::move(any));
  }
  if (phrase.value) {
    auto tag = std::make_unique<Expansion>();
    tag->kind = Expansion::Kind::kTag;
    tag->text = *phrase.value;
    parts.push_back(std::move(tag));
  }
  grammar->rules.emplace(grammar->root, std::move(rule));
  return grammar;
}

}  // namespace vxml
