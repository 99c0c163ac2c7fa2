#include "task_manager/interpreter/collect_phase.h"

#include <algorithm>

#include "task_manager/document/schema.h"
#include "task_manager/document/values.h"
#include "task_manager/interpreter/talk_object.h"

namespace vxml {

using script::Value;

void CollectPhase::Visit(FormItem& item) {
  switch (item.kind) {
    case ItemKind::kBlock:
      return VisitBlock(item);
    case ItemKind::kInitial:
    case ItemKind::kField:
    case ItemKind::kMenu:
      return VisitInput(item);
    case ItemKind::kRecord:
      return VisitRecord(item);
    case ItemKind::kTransfer:
      return VisitTransfer(item);
    case ItemKind::kSubdialog:
      return VisitSubdialog(item);
    case ItemKind::kObject:
      return VisitObject(item);
  }
}

void CollectPhase::VisitBlock(FormItem& item) {
  rt_.scopes.Store(item.name, rt_.engine.Boolean(true));
  item.over = !item.node->Has("name");  // nobody knows the name it was given
  content_.RunBlock(*item.node);
}

void CollectPhase::VisitInput(FormItem& item) {
  const bool modal = item.kind == ItemKind::kField && item.node->Get("modal") == "true";
  const std::vector<ActiveGrammar> active = GrammarsOf(item, modal);
  if (active.empty()) {
    rt_.position.ThrowSemantic(*item.node, "input is expected, but no grammar is active");
  }
  rt_.connection.RequireOpen();
  const Listen listen = recognition_.MakeListen(item, active);
  recognition_.Forget();
  const Input input = rt_.platform.Collect(queue_.Take(), listen);
  rt_.budget.Renew();
  process_.Process(recognition_.Interpret(input, active), &item);
}

void CollectPhase::VisitObject(FormItem& item) {
  // The event's name is fixed by VoiceXML 2.0 section 2.3.5.
  static constexpr const char* kUnsupported = "error.unsupported.objectname";
  const std::string classid = item.node->Get("classid");
  if (classid != "builtin:chat") ThrowEvent(kUnsupported, "no object '" + classid + "'");
  rt_.connection.RequireOpen();
  const TalkRequest request = MakeTalkRequest(item);
  recognition_.Forget();
  const TalkResult result = rt_.platform.Talk(queue_.Take(), request);
  rt_.budget.Renew();
  switch (result.kind) {
    case TalkResult::Kind::kHangup:
      rt_.connection.HangUp();
    case TalkResult::Kind::kUnsupported:
      ThrowEvent(kUnsupported, "object '" + classid + "': " + result.reason);
    case TalkResult::Kind::kBusy:
      ThrowEvent("error.noresource", "object '" + classid + "': " + result.reason);
    case TalkResult::Kind::kFailed:
      ThrowEvent("error.badfetch", "object '" + classid + "': " + result.reason);
    case TalkResult::Kind::kOver:
      return process_.FillPlain(item, ResultOfTalk(rt_.engine, result));
  }
}

NamedValues CollectPhase::ParametersOf(const vm::xml::Node& node) {
  NamedValues parameters;
  for (const auto& child : node.children) {
    if (!child->IsElement("param")) continue;
    const std::string* expression = child->Find("expr");
    parameters.emplace_back(child->Get("name"), expression
                                                    ? rt_.scopes.Evaluate(*child, *expression)
                                                    : rt_.engine.String(child->Get("value")));
  }
  return parameters;
}

TalkRequest CollectPhase::MakeTalkRequest(const FormItem& item) {
  TalkRequest request;
  for (const auto& [name, value] : ParametersOf(*item.node)) {
    const std::string fault = SetTalkParameter(name, rt_.engine.ToString(value), request);
    if (!fault.empty()) rt_.position.ThrowSemantic(*item.node, "object builtin:chat: " + fault);
  }
  return request;
}

void CollectPhase::VisitSubdialog(FormItem& item) {
  const vm::xml::Node& node = *item.node;
  NamedValues parameters = ParametersOf(node);
  Submission submission{documents_.FieldsOf(node, node.Get("namelist")),
                        node.Get("method") == "post", node.Get("enctype") == "multipart/form-data"};
  Transition start = documents_.Submit(node, rt_.scopes.Text(node, "src", "srcexpr"),
                                       std::move(submission), false);
  start.same_document = false;
  start.parameters = std::move(parameters);
  try {
    run_subdialog_(std::move(start));
  } catch (const ReturnToCaller& back) {
    if (back.is_event) throw EventThrown(back.event);
    const Value result = rt_.engine.Object();
    for (const auto& [name, value] : back.values) {
      rt_.engine.Set(result, name.substr(name.rfind('.') + 1), value);
    }
    return process_.FillPlain(item, result);
  }
  // The subdialog ran out of things to do: as an <exit>, the whole session ends.
  throw ExitSession{"end"};
}

RecordRequest CollectPhase::MakeRecordRequest(const FormItem& item,
                                              const std::vector<ActiveGrammar>& active) {
  static constexpr std::string_view kTypes =
      "audio/basic audio/x-alaw-basic audio/x-wav audio/wav audio/vnd.wave audio/mpeg";
  const vm::xml::Node& node = *item.node;
  RecordRequest request;
  request.listen = recognition_.MakeListen(item, active);
  request.beep = node.Get("beep") == "true";
  request.dtmf_term = node.Get("dtmfterm") != "false";
  if (const auto time = ParseTime(node.Get("maxtime"))) request.max_time = *time;
  if (const auto time = ParseTime(node.Get("finalsilence"))) request.final_silence = *time;
  request.type = node.Get("type", "audio/x-wav");
  const auto types = SplitWords(kTypes);
  if (std::ranges::find(types, request.type.substr(0, request.type.find(';'))) == types.end()) {
    ThrowEvent("error.unsupported.format", "recording as '" + request.type + "'");
  }
  return request;
}

Value CollectPhase::KeepRecording(const FormItem& item, const RecordResult& result,
                                  const std::string& type, const std::string& termchar) {
  script::Engine& engine = rt_.engine;
  const Value shadow = engine.Object();
  engine.Set(shadow, "duration", engine.Number(static_cast<double>(result.duration.count())));
  engine.Set(shadow, "size", engine.Number(static_cast<double>(result.bytes)));
  engine.Set(shadow, "termchar", termchar.empty() ? engine.Null() : engine.String(termchar));
  engine.Set(shadow, "maxtime", engine.Boolean(result.reached_max));
  rt_.scopes.Store(item.name + "$", shadow);
  return MakeRecording(engine, result.uri, type.substr(0, type.find(';')), result.duration);
}

void CollectPhase::VisitRecord(FormItem& item) {
  rt_.connection.RequireOpen();
  const auto active = GrammarsOf(item, item.node->Get("modal") != "false");
  const RecordRequest request = MakeRecordRequest(item, active);
  recognition_.Forget();
  const RecordResult result = rt_.platform.Record(queue_.Take(), request);
  rt_.budget.Renew();
  switch (result.kind) {
    case RecordResult::Kind::kSilence:
      ThrowEvent("noinput");
    case RecordResult::Kind::kUnsupported:
      ThrowEvent("error.unsupported.record");
    case RecordResult::Kind::kBadFormat:
      ThrowEvent("error.unsupported.format", "recording as '" + request.type + "'");
    case RecordResult::Kind::kHangup:
      if (result.duration.count() > 0) {
        rt_.scopes.Store(item.name, KeepRecording(item, result, request.type, ""));
      }
      rt_.connection.HangUp();
    case RecordResult::Kind::kRecorded:
      return process_.FillPlain(item, KeepRecording(item, result, request.type, result.termchar));
    case RecordResult::Kind::kInput:
      break;
  }
  const Match match = recognition_.Interpret(result.input, active);
  if (match.owner != Match::Owner::kItem) return process_.Process(match, &item);
  const Value recording =
      KeepRecording(item, result, request.type, match.dtmf ? match.utterance : "");
  recognition_.Describe(rt_.scopes.Get(item.name + "$"), match);
  process_.FillPlain(item, recording);
}

TransferRequest CollectPhase::MakeTransferRequest(const FormItem& item) {
  const vm::xml::Node& node = *item.node;
  TransferRequest request;
  request.destination = rt_.scopes.Text(node, "dest", "destexpr");
  request.type = rt_.scopes.Text(node, "type", "typeexpr");
  if (request.type.empty()) request.type = node.Get("bridge") == "true" ? "bridge" : "blind";
  if (request.type != "bridge" && request.type != "blind" && request.type != "consultation") {
    ThrowEvent("error.unsupported.transfer." + request.type);
  }
  if (const auto time = ParseTime(node.Get("connecttimeout"))) request.connect_timeout = *time;
  if (const auto time = ParseTime(node.Get("maxtime"))) request.max_time = *time;
  if (request.destination.empty()) {
    ThrowEvent("error.connection.baddestination", "a transfer without destination");
  }
  return request;
}

void CollectPhase::VisitTransfer(FormItem& item) {
  rt_.connection.RequireOpen();
  TransferRequest request = MakeTransferRequest(item);
  const std::vector<ActiveGrammar> active =
      request.type == "blind" ? std::vector<ActiveGrammar>{} : GrammarsOf(item, true);
  request.listen = recognition_.MakeListen(item, active);
  recognition_.Forget();
  const TransferResult result = rt_.platform.Transfer(queue_.Take(), request);
  rt_.budget.Renew();
  if (result.outcome.starts_with("connection.disconnect")) rt_.connection.Close();
  if (result.outcome.starts_with("connection.") || result.outcome.starts_with("error.")) {
    ThrowEvent(result.outcome);
  }
  script::Engine& engine = rt_.engine;
  const Value shadow = engine.Object();
  static constexpr std::string_view kNeverConnected = "busy noanswer network_busy";
  const auto failures = SplitWords(kNeverConnected);
  const bool connected = std::ranges::find(failures, result.outcome) == failures.end();
  engine.Set(shadow, "duration",
             engine.Number(connected ? static_cast<double>(result.duration.count()) / 1000.0 : 0));
  engine.Set(shadow, "inputmode", engine.Undefined());
  engine.Set(shadow, "utterance", engine.Undefined());
  if (result.ended_by_input) {
    const Match match = recognition_.Interpret(result.input, active);
    engine.Set(shadow, "inputmode", engine.String(match.dtmf ? "dtmf" : "voice"));
    engine.Set(shadow, "utterance", engine.String(match.utterance));
  }
  rt_.scopes.Store(item.name + "$", shadow);
  process_.FillPlain(item,
                     engine.String(result.ended_by_input ? "near_end_disconnect" : result.outcome));
}

}  // namespace vxml
