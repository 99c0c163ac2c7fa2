#include "task_manager/grammar/store.h"

#include <utility>

#include "task_manager/fetch/uri.h"

namespace vxml::srgs {

GrammarStore::GrammarStore(Fetch fetch) : fetch_(std::move(fetch)) {}

vm::Result<const Grammar*> GrammarStore::Add(std::unique_ptr<Grammar> grammar) {
  if (auto linked = Link(*grammar); !linked) return std::unexpected(linked.error());
  others_.push_back(std::move(grammar));
  return others_.back().get();
}

vm::Result<const Grammar*> GrammarStore::Load(const std::string& uri, const GrammarContext& context,
                                              const Rule** rule) {
  auto grammar = Fetched(fetch::WithoutFragment(uri), context);
  if (!grammar) return std::unexpected(grammar.error());
  if (!rule) return *grammar;
  const std::string name = fetch::Fragment(uri);
  *rule = name.empty() ? (*grammar)->RootRule() : (*grammar)->Find(name);
  if (!*rule) {
    return vm::Fail(vm::Errc::kBadValue,
                    uri + (name.empty() ? ": the grammar has no root rule"
                                        : ": the grammar has no rule '" + name + "'"));
  }
  if (!(*rule)->is_public && !name.empty() && name != (*grammar)->root) {
    return vm::Fail(vm::Errc::kBadValue, uri + ": rule '" + name + "' is private");
  }
  return *grammar;
}

vm::Result<Grammar*> GrammarStore::Fetched(const std::string& uri, const GrammarContext& context) {
  if (!fetch::MayRead(context.uri, uri)) {  // also where somebody else had it fetched
    return vm::Fail(vm::Errc::kAccess, uri + ": " + context.uri + " may not read files");
  }
  if (const auto found = by_uri_.find(uri); found != by_uri_.end()) return found->second.get();
  if (by_uri_.size() >= kMaxGrammars) {
    return vm::Fail(vm::Errc::kLimit,
                    uri + ": more than " + std::to_string(kMaxGrammars) + " grammars");
  }
  auto bytes = fetch_(uri);
  if (!bytes) return std::unexpected(bytes.error());
  GrammarContext own = context;
  own.uri = uri;
  own.base = uri;
  auto compiled = CompileBytes(*bytes, own);
  if (!compiled) return std::unexpected(compiled.error());
  Grammar* grammar = compiled->get();
  by_uri_.emplace(uri, std::move(*compiled));
  if (auto linked = Link(*grammar); !linked) {
    // Others may already point into it: it stays, but cannot be had again by its name.
    others_.push_back(std::move(by_uri_[uri]));
    by_uri_.erase(uri);
    return std::unexpected(linked.error());
  }
  return grammar;
}

vm::Result<void> GrammarStore::Link(Grammar& grammar) {
  for (auto& [name, rule] : grammar.rules) {
    if (!rule->expansion) continue;
    if (auto linked = LinkExpansion(grammar, *rule->expansion); !linked) return linked;
  }
  return {};
}

vm::Result<void> GrammarStore::LinkExpansion(Grammar& grammar, Expansion& node) {
  if (++expansions_ > kMaxExpansions) {
    return vm::Fail(vm::Errc::kLimit, grammar.uri + ": grammars of more than " +
                                          std::to_string(kMaxExpansions) + " words and parts");
  }
  if (node.kind == Expansion::Kind::kReference) return LinkReference(grammar, node);
  for (auto& child : node.children) {
    if (auto linked = LinkExpansion(grammar, *child); !linked) return linked;
  }
  return {};
}

vm::Result<void> GrammarStore::LinkReference(Grammar& grammar, Expansion& node) {
  const std::string place =
      grammar.uri +
      (node.line ? ":" + std::to_string(node.line) + ":" + std::to_string(node.column) : "");
  if (node.uri.empty()) {
    node.target = grammar.Find(node.rule);
    if (!node.target) {
      return vm::Fail(vm::Errc::kBadValue, place + ": there is no rule '" + node.rule + "'");
    }
    return {};
  }
  const auto form = FormOfType(node.type);
  if (!form && !node.type.empty()) {
    return vm::Fail(vm::Errc::kUnavailable,
                    place + ": grammars of type '" + node.type + "' are not known");
  }
  GrammarContext context;
  context.uri = grammar.uri;
  context.language = grammar.language;
  if (!grammar.alone) context.mode = grammar.mode;
  context.alone = grammar.alone;
  // A base may itself be relative: to the place of the grammar.
  const std::string base = grammar.base.empty() || grammar.uri.starts_with("platform:")
                               ? grammar.uri
                               : fetch::Resolve(grammar.uri, grammar.base);
  const std::string uri = fetch::Resolve(base, node.text);
  const Rule* rule = nullptr;
  auto loaded = Load(uri, context, &rule);
  if (!loaded) return vm::Fail(loaded.error().code, place + ": " + loaded.error().text);
  if (form && rule->grammar->form != *form) {
    return vm::Fail(vm::Errc::kBadValue, place + ": " + uri + " is not of the type " + node.type);
  }
  if (rule->grammar->mode != grammar.mode) {
    return vm::Fail(vm::Errc::kBadValue, place + ": a voice and a dtmf grammar cannot be mixed");
  }
  node.target = rule;
  return {};
}

}  // namespace vxml::srgs
