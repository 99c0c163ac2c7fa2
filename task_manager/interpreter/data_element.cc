// <data>: XML as a read-only DOM (VoiceXML 2.1 section 5).
#include <nlohmann/json.hpp>

#include "task_manager/document/schema.h"
#include "task_manager/interpreter/executable_content.h"
#include "vm_protocol/xml/parser.h"

namespace vxml {
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
bool AllowsHost(const vm::xml::XmlDocument& data, const std::string& host) {
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

void ExecutableContent::RunData(const vm::xml::Node& node) {
  fetch::Request request = documents_.RequestFor(node, "data");
  request.uri = fetch::Resolve(rt_.position.BaseOf(node), rt_.scopes.Text(node, "src", "srcexpr"));
  request.fields = documents_.FieldsOf(node, node.Get("namelist"));
  request.post = node.Get("method") == "post";
  request.multipart = node.Get("enctype") == "multipart/form-data";
  const fetch::Response got = documents_.Fetch(node, request, "data");
  if (!node.Has("name")) return;
  auto data = vm::xml::Parse(got.body, got.uri, got.charset);
  if (!data) ThrowEvent("error.badfetch", data.error().text);
  const std::string host = fetch::Host(rt_.position.OriginOf(node).uri);
  if (!AllowsHost(*data, host)) {
    ThrowEvent("error.noauthorization", got.uri + ": access-control does not allow " + host);
  }
  auto nodes = nlohmann::json::array();
  for (const auto& before : data->prolog) nodes.push_back(SpecOf(*before));
  nodes.push_back(SpecOf(*data->root));
  for (const auto& behind : data->epilog) nodes.push_back(SpecOf(*behind));
  auto dom = rt_.engine.Dom(JsonText(nodes));
  if (!dom) rt_.scopes.Throw(node, got.uri, dom.error());
  rt_.scopes.Declare(node, node.Get("name"), *dom);
}

}  // namespace vxml
