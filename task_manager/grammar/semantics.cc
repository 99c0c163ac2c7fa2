#include "task_manager/grammar/semantics.h"

#include "task_manager/script/rewriter.h"
#include "task_manager/xml/node.h"

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

/// Drafts of SISR wrote $ for out, $$ for rules.latest() and $name for rules.name.
std::string FromDraft(const std::string& tag) {
  auto tokens = script::Tokenize(tag);
  if (!tokens) return tag;
  std::string code;
  for (const script::Token& token : *tokens) {
    code += token.before;
    if (token.text == "$") {
      code += "out";
    } else if (token.text == "$$") {
      code += "rules.latest()";
    } else if (token.type == script::Token::Type::kWord && token.text.starts_with("$")) {
      code += "rules." + std::string(token.text.substr(1));
    } else {
      code += token.text;
    }
  }
  return code;
}

class Interpreter {
 public:
  explicit Interpreter(Engine& engine) : engine_(engine) {}

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
        rules.push_back({item.rule->name, {*value, item.rule->Text()}});
        if (scope.valid()) Publish(scope, rules.back());
      } else if (item.kind == ParseItem::Kind::kTag) {
        const bool script =
            style == TagStyle::kScript || (style == TagStyle::kGuess && LooksLikeScript(item.text));
        if (!script) {
          result = engine_.String(style == TagStyle::kLiteral ? item.text
                                                              : std::string(xml::Trim(item.text)));
          tagged = true;
          continue;
        }
        if (!scope.valid()) {
          scope = MakeScope(parse);
          for (const auto& rule : rules) Publish(scope, rule);
        }
        const std::string code = style == TagStyle::kGuess ? FromDraft(item.text) : item.text;
        if (auto ran = engine_.Run({*globals, scope}, code); !ran) {
          return vm::Fail(ran.error().code, "tag '" + item.text + "': " + ran.error().text);
        }
        result = engine_.Get(scope, "out");
        tagged = true;
      }
    }
    if (tagged) return result;
    if (!rules.empty()) return rules.back().second.first;
    return engine_.String(parse.Text());
  }

 private:
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
    engine_.Set(scope, "__text", engine_.String(parse.Text()));
    const Value helpers =
        engine_
            .Evaluate({scope},
                      "(function(text){return {"
                      "rules:{latest:function(){}},"
                      "meta:{latest:function(){},current:function(){return {text:text,score:1};}}"
                      "};})(__text)")
            .value_or(Value());
    engine_.Remove(scope, "__text");
    engine_.Set(scope, "rules", engine_.Get(helpers, "rules"));
    engine_.Set(scope, "meta", engine_.Get(helpers, "meta"));
    return scope;
  }

  void Publish(const Value& scope,
               const std::pair<std::string, std::pair<Value, std::string>>& rule) {
    Value arguments = engine_.NewScope();
    engine_.Set(arguments, "__r", engine_.Get(scope, "rules"));
    engine_.Set(arguments, "__m", engine_.Get(scope, "meta"));
    engine_.Set(arguments, "__n", engine_.String(rule.first));
    engine_.Set(arguments, "__o", rule.second.first);
    engine_.Set(arguments, "__t2", engine_.String(rule.second.second));
    auto done = engine_.Evaluate(
        {arguments},
        "(__r[__n]=__o, __m[__n]={text:__t2,score:1},"
        "(function(o,m){__r.latest=function(){return o;};__m.latest=function(){return m;};})"
        "(__o,__m[__n]))");
    static_cast<void>(done);
  }

  Engine& engine_;
  std::map<const Grammar*, Value> globals_;
};

}  // namespace

vm::Result<Value> Interpret(Engine& engine, const Parse& parse) {
  return Interpreter(engine).Run(parse, 0);
}

}  // namespace vxml::srgs
