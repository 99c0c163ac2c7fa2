#include "task_manager/grammar/semantics.h"

#include "task_manager/script/engine.h"
#include "vm_protocol/xml/node.h"

namespace vxml::srgs {
namespace {

using script::Chain;
using script::Engine;
using script::Value;

enum class TagStyle { kScript, kLiteral, kGuess };

TagStyle StyleOf(const std::string& format) {
  if (format.starts_with("semantics/1.0")) {
    return format.ends_with("-literals") ? TagStyle::kLiteral : TagStyle::kScript;
  }
  return TagStyle::kGuess;
}

/// Tags of no declared format are scripts if they speak of the rule's value or assign something.
bool LooksLikeScript(std::string_view tag) {
  if (tag.find("out") == std::string_view::npos && tag.find('$') == std::string_view::npos) {
    return false;
  }
  return tag.find('=') != std::string_view::npos || tag.find('.') != std::string_view::npos;
}

class Interpreter {
 public:
  Interpreter(Engine& engine, const Parse& whole, const std::string& spoken)
      : engine_(engine), whole_(whole), spoken_(spoken) {}

  vm::Result<Value> Run(const Parse& parse, int depth) {
    if (depth > 500) return vm::Fail(vm::Errc::kLimit, "rules nested deeper than 500");
    const TagStyle style =
        parse.rule->grammar ? StyleOf(parse.rule->grammar->tag_format) : TagStyle::kGuess;
    auto globals = GlobalsOf(*parse.rule);
    if (!globals) return globals;
    Value scope;  // made when a script needs it
    std::vector<std::pair<std::string, std::pair<Value, std::string>>> rules;
    Value result;
    bool tagged = false;
    for (const ParseItem& item : parse.items) {
      if (item.kind == ParseItem::Kind::kRule) {
        auto value = Run(*item.rule, depth + 1);
        if (!value) return value;
        rules.push_back({item.rule->name, {*value, TextOf(*item.rule)}});
        if (scope.valid()) Publish(scope, rules.back());
      } else if (item.kind == ParseItem::Kind::kTag) {
        const bool script =
            style == TagStyle::kScript || (style == TagStyle::kGuess && LooksLikeScript(item.text));
        if (!script) {
          result = engine_.String(
              style == TagStyle::kLiteral ? item.text : std::string(vm::xml::Trim(item.text)));
          tagged = true;
          continue;
        }
        if (!scope.valid()) {
          scope = MakeScope(parse);
          for (const auto& rule : rules) Publish(scope, rule);
        }
        if (auto ran = engine_.Run({*globals, scope}, item.text); !ran) {
          return vm::Fail(ran.error().code, "tag '" + item.text + "': " + ran.error().text);
        }
        result = engine_.Get(scope, "out");
        tagged = true;
      }
    }
    if (tagged) return result;
    if (!rules.empty()) return rules.back().second.first;
    return engine_.String(TextOf(parse));
  }

 private:
  std::string TextOf(const Parse& parse) const {
    return parse.begin == whole_.begin && parse.end == whole_.end ? spoken_ : parse.Text();
  }

  vm::Result<Value> GlobalsOf(const Rule& rule) {
    const auto found = globals_.find(rule.grammar);
    if (found != globals_.end()) return found->second;
    Value scope = engine_.NewScope();
    if (rule.grammar) {
      for (const std::string& tag : rule.grammar->header_tags) {
        if (auto ran = engine_.Run({scope}, tag); !ran) return std::unexpected(ran.error());
      }
      engine_.Freeze(scope);
    }
    globals_.emplace(rule.grammar, scope);
    return scope;
  }

  Value MakeScope(const Parse& parse) {
    Value scope = engine_.NewScope();
    engine_.Set(scope, "out", engine_.Object());
    Value arguments = engine_.NewScope();
    engine_.Set(arguments, "scope", scope);
    engine_.Set(arguments, "spoken", engine_.String(TextOf(parse)));
    // Drafts of SISR wrote $ for out, $$ for rules.latest() and $name for rules.name.
    static_cast<void>(engine_.Run({arguments}, R"js(
      scope.rules = { latest() {} };
      scope.meta = { latest() {}, current: (text => () => ({ text, score: 1 }))(spoken) };
      Object.defineProperties(scope, {
        $: { get() { return this.out; }, set(value) { this.out = value; } },
        $$: { get() { return this.rules.latest(); } } });)js"));
    return scope;
  }

  void Publish(const Value& scope,
               const std::pair<std::string, std::pair<Value, std::string>>& rule) {
    Value arguments = engine_.NewScope();
    engine_.Set(arguments, "scope", scope);
    engine_.Set(arguments, "name", engine_.String(rule.first));
    engine_.Set(arguments, "value", rule.second.first);
    engine_.Set(arguments, "text", engine_.String(rule.second.second));
    static_cast<void>(engine_.Run({arguments}, R"js(
      ((value, meta) => {
        scope.rules[name] = scope['$' + name] = value;
        scope.rules.latest = () => value;
        scope.meta[name] = meta;
        scope.meta.latest = () => meta;
      })(value, { text, score: 1 });)js"));
  }

  Engine& engine_;
  const Parse& whole_;
  const std::string& spoken_;
  std::map<const Grammar*, Value> globals_;
};

}  // namespace

vm::Result<Value> Interpret(Engine& engine, const Parse& parse, const std::string& spoken) {
  return Interpreter(engine, parse, spoken).Run(parse, 0);
}

}  // namespace vxml::srgs
