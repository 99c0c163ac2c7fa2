#include <nlohmann/json.hpp>

#include "task_manager/document/schema.h"
#include "task_manager/fetch/uri.h"
#include "task_manager/interpreter/dialog_session.h"
#include "vm_protocol/xml/parser.h"

namespace vxml {

using script::Value;

void DialogSession::RunGoto(const vm::xml::Node& node) {
  if (node.Has("nextitem") || node.Has("expritem")) {
    const std::string* expression = node.Find("expritem");
    const std::string item = expression ? TextOf(node, *expression) : node.Get("nextitem");
    bool known = false;
    if (dialog_) {
      for (const Item& candidate : dialog_->items) known = known || candidate.name == item;
    }
    if (!known) ThrowEvent("error.badfetch", "the form has no item '" + item + "'");
    throw GoToItem{item};
  }
  std::string next = node.Get("next");
  if (const std::string* expression = node.Find("expr")) next = TextOf(node, *expression);
  throw Locate(node, next, "document");
}

void DialogSession::RunSubmit(const vm::xml::Node& node) {
  std::string next = node.Get("next");
  if (const std::string* expression = node.Find("expr")) next = TextOf(node, *expression);
  std::string namelist = node.Get("namelist");
  if (!node.Has("namelist") && dialog_) {  // all input items the document names
    for (const Item& item : dialog_->items) {
      if (item.IsInput() && item.node->Has("name")) namelist += " " + item.name;
    }
  }
  const std::string enctype = node.Get("enctype", "application/x-www-form-urlencoded");
  if (enctype != "application/x-www-form-urlencoded" && enctype != "multipart/form-data") {
    ThrowEvent("error.badfetch", "enctype '" + enctype + "' is not known");
  }
  const bool post = node.Get("method", "get") == "post";
  throw Locate(node, next, "document", SubmitFields(node, namelist), post,
               enctype == "multipart/form-data", true);
}

std::vector<fetch::Field> DialogSession::SubmitFields(const vm::xml::Node& node,
                                                      const std::string& namelist) {
  std::vector<fetch::Field> fields;
  for (const std::string_view word : SplitWords(namelist)) {
    const std::string name(word);
    Flatten(name, Evaluate(node, name), fields, 0);
  }
  return fields;
}

/// Objects are sent property by property, as a.b=value.
void DialogSession::Flatten(const std::string& name, const Value& value,
                            std::vector<fetch::Field>& fields, int depth) {
  if (depth > 8 || fields.size() > 10'000) return;
  if (IsRecording(value)) {
    // A recording: its bytes where the platform keeps them, else only its name.
    const std::string uri = engine_.ToString(engine_.Get(value, "uri"));
    const auto bytes = platform_.Recording(uri);
    fields.push_back(
        {name, bytes ? *bytes : "", engine_.ToString(engine_.Get(value, "type")), name + ".wav"});
    return;
  }
  if (engine_.IsObject(value)) {
    for (const std::string& key : engine_.Keys(value)) {
      Flatten(name + "." + key, engine_.Get(value, key), fields, depth + 1);
    }
    return;
  }
  if (engine_.IsUndefined(value) && depth > 0) return;
  fields.push_back({name, engine_.IsUndefined(value) ? "" : engine_.ToString(value), "", ""});
}

void DialogSession::RunExit(const vm::xml::Node& node) {
  std::string json = "undefined";
  if (const std::string* expression = node.Find("expr")) {
    json = engine_.ToJson(Evaluate(node, *expression));
  } else if (const std::string* namelist = node.Find("namelist")) {
    const Value values = engine_.Object();
    for (const std::string_view word : SplitWords(*namelist)) {
      engine_.Set(values, std::string(word), Evaluate(node, std::string(word)));
    }
    json = engine_.ToJson(values);
  }
  throw ExitSession{"exit", json};
}

void DialogSession::RunReturn(const vm::xml::Node& node) {
  if (!context_->is_subdialog) {
    ThrowSemantic(*context_->document, node, "<return> outside of a subdialog");
  }
  ReturnToCaller back;
  std::string event = node.Get("event");
  if (const std::string* expression = node.Find("eventexpr")) event = TextOf(node, *expression);
  if (!event.empty()) {
    back.is_event = true;
    back.event.name = event;
    if (const std::string* message = node.Find("message")) {
      back.event.message = *message;
      back.event.has_message = true;
    } else if (const std::string* expression = node.Find("messageexpr")) {
      back.event.message = TextOf(node, *expression);
      back.event.has_message = true;
    }
    throw back;
  }
  const std::string namelist = node.Get("namelist");
  for (const std::string_view word : SplitWords(namelist)) {
    const std::string name(word);
    back.values.emplace_back(name, Evaluate(node, name));
  }
  throw back;
}

void DialogSession::RunDisconnect(const vm::xml::Node& node) {
  std::string json = "undefined";
  if (const std::string* namelist = node.Find("namelist")) {
    const Value values = engine_.Object();
    for (const std::string_view word : SplitWords(*namelist)) {
      engine_.Set(values, std::string(word), Evaluate(node, std::string(word)));
    }
    json = engine_.ToJson(values);
  }
  if (!hung_up_ && !disconnected_) Flush();
  disconnected_ = true;
  JsonLine line;
  line.Raw("value", json);
  platform_.Report("disconnect", line);
  platform_.Disconnect();
  ThrowEvent("connection.disconnect.hangup");
}

namespace {

/// A node as prelude.js wants it: [type, name, text, namespace, [attribute...], [child...]].
nlohmann::json SpecOf(const vm::xml::Node& node) {
  using Kind = vm::xml::Node::Kind;
  using nlohmann::json;
  const auto none = json::array();
  const auto space = [](const std::string& uri) { return uri.empty() ? json() : json(uri); };
  switch (node.kind) {
    case Kind::kText:
      return {node.cdata ? 4 : 3,
              node.cdata ? "#cdata-section" : "#text",
              node.text,
              nullptr,
              none,
              none};
    case Kind::kComment:
      return {8, "#comment", node.text, nullptr, none, none};
    case Kind::kInstruction:
      return {7, node.name, node.text, nullptr, none, none};
    case Kind::kElement:
      break;
  }
  auto attributes = none;
  for (const vm::xml::Attribute& attribute : node.attributes) {
    attributes.push_back({attribute.name, space(attribute.space), attribute.value});
  }
  auto children = none;
  for (const auto& child : node.children) children.push_back(SpecOf(*child));
  const std::string name = node.prefix.empty() ? node.name : node.prefix + ":" + node.name;
  return json::array(
      {1, name, nullptr, space(node.space), std::move(attributes), std::move(children)});
}

/// <?access-control allow="HOST ..."?> (VoiceXML 2.1 section 5, appendix E).
bool MayRead(const vm::xml::XmlDocument& data, const std::string& host) {
  for (const auto& instruction : data.prolog) {
    if (instruction->name != "access-control") continue;
    const std::string& text = instruction->text;
    const std::size_t at = text.find("allow");
    if (at == std::string::npos) return false;
    const std::size_t open = text.find_first_of("\"'", at);
    if (open == std::string::npos) return false;
    const std::string list = text.substr(open + 1, text.find(text[open], open + 1) - open - 1);
    for (const std::string_view word : SplitWords(list)) {
      if (word == "*" || word == host) return true;
      if (word.starts_with("*.") && host.ends_with(word.substr(1))) return true;
    }
    return false;
  }
  return true;
}

}  // namespace

void DialogSession::RunData(const vm::xml::Node& node) {
  std::string source = node.Get("src");
  if (const std::string* expression = node.Find("srcexpr")) source = TextOf(node, *expression);
  fetch::Request request = FetchOptions(node, "data");
  request.uri = fetch::Resolve(BaseOf(node), source);
  request.fields = SubmitFields(node, node.Get("namelist"));
  request.post = node.Get("method", "get") == "post";
  request.multipart = node.Get("enctype") == "multipart/form-data";
  const fetch::Response got = FetchFor(node, request, "data");
  if (!node.Has("name")) return;
  auto data = vm::xml::Parse(got.body, got.uri, got.charset);
  if (!data) ThrowEvent("error.badfetch", data.error().text);
  const std::string host = fetch::Host(OriginOf(node).uri);
  if (!MayRead(*data, host)) {
    ThrowEvent("error.noauthorization", got.uri + ": access-control does not allow " + host);
  }
  auto nodes = nlohmann::json::array();
  for (const auto& before : data->prolog) nodes.push_back(SpecOf(*before));
  nodes.push_back(SpecOf(*data->root));
  for (const auto& behind : data->epilog) nodes.push_back(SpecOf(*behind));
  auto dom = engine_.Dom(JsonText(nodes));
  if (!dom) ThrowSemantic(*context_->document, node, dom.error().text);
  Declare(node, node.Get("name"), *dom);
}

}  // namespace vxml
