#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>

#include "task_manager/app/options.h"
#include "task_manager/document/emotionml.h"
#include "task_manager/document/schema.h"
#include "task_manager/fetch/uri.h"
#include "task_manager/grammar/builtin.h"
#include "task_manager/grammar/store.h"
#include "vm_protocol/xml/parser.h"

namespace vxml {
namespace {

/// Reads a document without refusing it for its structure.
struct Loose {
  VxmlDocument document;
  std::vector<Finding> findings;
};

class DeepChecker {
 public:
  DeepChecker(VxmlDocument& document, fetch::Fetcher& fetcher)
      : document_(document),
        fetcher_(fetcher),
        store_([this](const std::string& uri) -> vm::Result<std::string> {
          auto got = fetcher_.Get(uri);
          if (!got) return std::unexpected(got.error());
          return std::move(got->body);
        }) {}

  std::vector<Finding> Run() {
    Visit(*document_.root);
    return std::move(findings_);
  }

 private:
  void Say(const vm::xml::Node& at, std::string text, std::string advice,
           Finding::Severity severity = Finding::Severity::kError) {
    findings_.push_back({severity, at.line, at.column, std::move(text), std::move(advice)});
  }

  void Visit(const vm::xml::Node& node) {
    if (!node.IsElement()) return;
    if (node.name == "grammar") return Grammar(node);
    for (const char* name : {"cond", "expr", "nextexpr", "eventexpr", "messageexpr", "srcexpr",
                             "destexpr", "nameexpr", "expritem", "array"}) {
      if (const std::string* expression = node.Find(name)) Expression(node, name, *expression);
    }
    if (node.name == "script") Script(node);
    if (const std::string* name = node.Find("name")) Name(node, *name);
    if (const std::string* next = node.Find("next")) Target(node, *next);
    if (node.name == "subdialog") {
      if (const std::string* source = node.Find("src")) Target(node, *source);
    }
    if (node.name == "field") Field(node);
    for (const auto& child : node.children) Visit(*child);
  }

  void Expression(const vm::xml::Node& node, const std::string& name, const std::string& text) {
    if (auto fit = engine_.CheckExpression(text); !fit) {
      Say(node, name + "=\"" + text + "\": " + fit.error().text, "");
    }
  }

  void Name(const vm::xml::Node& node, const std::string& name) {
    static constexpr std::string_view kDeclare =
        "var data block initial field record transfer subdialog object";
    const auto elements = SplitWords(kDeclare);
    if (std::ranges::find(elements, node.name) == elements.end() || !IsVoiceXml(node)) return;
    if (name.empty() || engine_.IsIdentifier(name)) return;
    Say(node, "'" + name + "' cannot be declared", "expected a name as ECMAScript has it");
  }

  void Script(const vm::xml::Node& node) {
    if (node.Has("src") || node.Has("srcexpr")) return;
    if (auto fit = engine_.CheckScript(node.Text()); !fit) {
      Say(node, "script: " + fit.error().text, "");
    }
  }

  void Target(const vm::xml::Node& node, const std::string& target) {
    if (target.starts_with("#")) {
      if (!document_.FindDialog(target.substr(1))) {
        Say(node, "there is no dialog '" + target.substr(1) + "' in this document",
            "give the id of a <form> or <menu>");
      }
      return;
    }
    if (target.starts_with("http")) return;
    const std::string uri = fetch::WithoutFragment(fetch::Resolve(document_.base, target));
    if (uri.starts_with("file:") && !seen_.contains(uri)) {
      seen_.insert(uri);
      if (!fetcher_.Get(uri)) Say(node, "'" + target + "' cannot be read", "");
    }
  }

  void Field(const vm::xml::Node& node) {
    if (const std::string* type = node.Find("type")) {
      if (!srgs::IsBuiltinType(srgs::ParseBuiltin(*type).type)) {
        Say(node, "type '" + *type + "' is not built in",
            "boolean, currency, date, digits, number, phone, time are");
      }
    } else if (!node.FirstElement("grammar") && !node.FirstElement("option") &&
               !(node.parent && node.parent->FirstElement("grammar"))) {
      Say(node, "<field> without grammar, type or option",
          "it can only be filled by a grammar of the form", Finding::Severity::kWarning);
    }
  }

  void Grammar(const vm::xml::Node& node) {
    if (const std::string* source = node.Find("src")) {
      if (source->starts_with("builtin:") || source->starts_with("http")) return;
      const srgs::Rule* rule = nullptr;
      auto loaded = store_.Load(fetch::Resolve(document_.base, *source), {}, &rule);
      if (!loaded) Say(node, loaded.error().text, "");
      return;
    }
    if (node.Has("srcexpr")) return;
    srgs::GrammarContext context;
    context.uri = document_.uri;
    context.base = document_.base;
    bool elements = false;
    for (const auto& child : node.children) elements = elements || child->IsElement();
    const std::string text(vm::xml::Trim(node.Text()));
    auto made = !elements && text.find('$') != std::string::npos ? srgs::CompileAbnf(text, context)
                                                                 : srgs::CompileXml(node, context);
    if (!made) return Say(node, "grammar: " + made.error().text, "");
    auto added = store_.Add(std::move(*made));
    if (!added) Say(node, "grammar: " + added.error().text, "");
  }

  VxmlDocument& document_;
  fetch::Fetcher& fetcher_;
  srgs::GrammarStore store_;
  script::Engine engine_;
  std::set<std::string> seen_;
  std::vector<Finding> findings_;
};

vm::Result<Loose> ReadLoosely(const std::string& uri, fetch::Fetcher& fetcher) {
  auto got = fetcher.Get(uri);
  if (!got) return std::unexpected(got.error());
  auto parsed = vm::xml::Parse(got->body, uri, got->charset);
  if (!parsed) return std::unexpected(parsed.error());
  Loose loose;
  loose.document.uri = loose.document.base = fetch::WithoutFragment(uri);
  loose.document.root = std::move(parsed->root);
  if (!IsEmotionMl(*loose.document.root)) {
    loose.document.passed_over = DropForeign(*loose.document.root);
  }
  loose.document.FindDialogs();
  const vm::xml::Node& root = *loose.document.root;
  loose.findings = IsEmotionMl(root) ? CheckEmotionMl(root) : CheckDocument(loose.document);
  return loose;
}

}  // namespace

int RunCheck(const Options& options) {
  const SessionOptions session = MakeSessionOptions(options);
  fetch::Fetcher fetcher(session.fetch);
  auto loose = ReadLoosely(session.uri, fetcher);
  if (!loose) {
    std::cout << loose.error().text << "\n";
    return kNotStarted;
  }
  std::vector<Finding> findings = std::move(loose->findings);
  if (loose->document.root->IsElement("vxml")) {
    for (Finding& finding : DeepChecker(loose->document, fetcher).Run()) {
      findings.push_back(std::move(finding));
    }
  }
  int errors = 0;
  for (const Finding& finding : findings) {
    std::cout << FormatFinding(options.document, finding) << "\n";
    errors += finding.severity == Finding::Severity::kError ? 1 : 0;
  }
  std::cout << options.document << ": " << errors << " errors, "
            << findings.size() - static_cast<std::size_t>(errors) << " warnings\n";
  return errors > 0 ? kNotStarted : kEnded;
}

namespace {

std::string DotId(const std::string& text) { return JsonText(text); }

void Edges(const vm::xml::Node& node, const std::string& from) {
  const auto edge = [&](const std::string& to, const std::string& label) {
    std::cout << "  " << DotId(from) << " -> " << DotId(to) << " [label=" << DotId(label) << "];\n";
  };
  std::string label = node.name;
  if (node.name == "choice" || node.name == "option") label = vm::xml::Collapse(node.Text());
  if (node.name == "catch") label = node.Get("event", "catch");
  if (const std::string* next = node.Find("next")) edge(*next, label);
  if (const std::string* expression = node.Find("expr"); expression && node.name == "goto") {
    edge("(" + *expression + ")", label);
  }
  if (const std::string* item = node.Find("nextitem")) edge(from + "/" + *item, label);
  if (node.name == "subdialog")
    edge(node.Get("src", node.Get("srcexpr")), "subdialog " + node.Get("name"));
  if (const std::string* event = node.Find("event"); event && node.name != "catch") {
    edge("event " + *event, label);
  }
  if (node.name == "exit") edge("exit", label);
  for (const auto& child : node.children) {
    if (child->IsElement() && child->name != "grammar") Edges(*child, from);
  }
}

}  // namespace

int RunGraph(const Options& options) {
  const SessionOptions session = MakeSessionOptions(options);
  fetch::Fetcher fetcher(session.fetch);
  auto loose = ReadLoosely(session.uri, fetcher);
  if (!loose) {
    std::cerr << "task_manager: " << loose.error().text << "\n";
    return kNotStarted;
  }
  std::cout << "digraph dialogue {\n  rankdir=LR;\n  node [shape=box];\n";
  int number = 0;
  for (const vm::xml::Node* dialog : loose->document.dialogs) {
    std::string id = dialog->Get("id");
    id = id.empty() ? dialog->name + std::to_string(++number) : "#" + id;
    std::string items;
    for (const auto& child : dialog->children) {
      if (child->IsElement() && child->Has("name"))
        items += "\n" + child->name + " " + child->Get("name");
    }
    std::cout << "  " << DotId(id) << " [label=" << DotId(dialog->name + " " + id + items)
              << "];\n";
    for (const auto& child : dialog->children) {
      if (child->IsElement()) Edges(*child, id);
    }
  }
  for (const auto& child : loose->document.root->children) {
    if (child->IsElement("link") || child->IsElement("catch")) Edges(*child, "(everywhere)");
  }
  std::cout << "}\n";
  return kEnded;
}

}  // namespace vxml
