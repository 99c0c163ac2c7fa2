// Executable content that leads somewhere else: each element throws where to (signals.h).
#include <algorithm>

#include "task_manager/document/schema.h"
#include "task_manager/interpreter/executable_content.h"

namespace vxml {

using script::Value;

void ExecutableContent::RunGoto(const vm::xml::Node& node) {
  if (!node.Has("nextitem") && !node.Has("expritem")) {
    throw documents_.Locate(node, rt_.scopes.Text(node, "next", "expr"));
  }
  const std::string item = rt_.scopes.Text(node, "nextitem", "expritem");
  if (!rt_.position.dialog || !rt_.position.dialog->FindItem(item)) {
    ThrowEvent("error.badfetch", "the form has no item '" + item + "'");
  }
  throw GoToItem{item};
}

void ExecutableContent::RunSubmit(const vm::xml::Node& node) {
  const std::string next = rt_.scopes.Text(node, "next", "expr");
  std::string namelist = node.Get("namelist");
  if (!node.Has("namelist") && rt_.position.dialog) {  // all input items the document names
    for (const FormItem& item : rt_.position.dialog->items) {
      if (item.IsInput() && item.node->Has("name")) namelist += " " + item.name;
    }
  }
  const std::string enctype = node.Get("enctype", "application/x-www-form-urlencoded");
  const bool multipart = enctype == "multipart/form-data";
  if (!multipart && enctype != "application/x-www-form-urlencoded") {
    ThrowEvent("error.badfetch", "enctype '" + enctype + "' is not known");
  }
  Submission submission{documents_.FieldsOf(node, namelist), node.Get("method") == "post",
                        multipart};
  throw documents_.Submit(node, next, std::move(submission), true);
}

std::string ExecutableContent::JsonOf(const vm::xml::Node& node, const std::string& namelist) {
  const Value values = rt_.engine.Object();
  for (const std::string_view word : SplitWords(namelist)) {
    const std::string name(word);
    rt_.engine.Set(values, name, rt_.scopes.Evaluate(node, name));
  }
  return rt_.engine.ToJson(values);
}

void ExecutableContent::RunExit(const vm::xml::Node& node) {
  ExitSession exit{"exit"};
  if (const std::string* expression = node.Find("expr")) {
    exit.value_json = rt_.engine.ToJson(rt_.scopes.Evaluate(node, *expression));
  } else if (const std::string* namelist = node.Find("namelist")) {
    exit.value_json = JsonOf(node, *namelist);
  }
  throw exit;
}

void ExecutableContent::RunReturn(const vm::xml::Node& node) {
  if (!rt_.position.in_subdialog) {
    rt_.position.ThrowSemantic(node, "<return> outside of a subdialog");
  }
  ReturnToCaller back;
  back.event = rt_.scopes.Event(node);
  back.is_event = !back.event.name.empty();
  const std::string namelist = back.is_event ? "" : node.Get("namelist");
  for (const std::string_view word : SplitWords(namelist)) {
    const std::string name(word);
    back.values.emplace_back(name, rt_.scopes.Evaluate(node, name));
  }
  throw back;
}

void ExecutableContent::RunDisconnect(const vm::xml::Node& node) {
  const std::string* namelist = node.Find("namelist");
  JsonLine line;
  line.Raw("value", namelist ? JsonOf(node, *namelist) : "undefined");
  if (rt_.connection.is_open()) queue_.Flush();
  rt_.connection.Close();
  rt_.platform.Report("disconnect", line);
  rt_.platform.Disconnect();
  ThrowEvent("connection.disconnect.hangup");
}

void ExecutableContent::RunThrow(const vm::xml::Node& node) { throw rt_.scopes.Event(node); }

}  // namespace vxml
