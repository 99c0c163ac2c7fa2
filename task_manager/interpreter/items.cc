#include "task_manager/document/schema.h"
#include "task_manager/interpreter/dialog_session.h"

namespace vxml {

using script::Value;

/// The item's variable gets a value that no grammar gave; its <filled> follow.
void DialogSession::FillPlain(Item& item, const Value& value) {
  Store(item.name, value);
  JsonLine line;
  line.Text("item", item.name).Raw("value", engine_.ToJson(value));
  platform_.Report("filled", line);
  RunFilled({item.name});
}

void DialogSession::VisitSubdialog(Item& item) {
  const vm::xml::Node& node = *item.node;
  if (subdialogs_ >= options_.max_subdialogs) {
    ThrowEvent("error.noresource",
               "subdialogs nested deeper than " + std::to_string(options_.max_subdialogs));
  }
  std::vector<std::pair<std::string, Value>> parameters;
  for (const auto& child : node.children) {
    if (!child->IsElement("param")) continue;
    const std::string* expression = child->Find("expr");
    parameters.emplace_back(child->Get("name"), expression ? Evaluate(*child, *expression)
                                                           : engine_.String(child->Get("value")));
  }
  std::string source = node.Get("src");
  if (const std::string* expression = node.Find("srcexpr")) source = TextOf(node, *expression);
  Transition start =
      Locate(node, source, "document", SubmitFields(node, node.Get("namelist")),
             node.Get("method", "get") == "post", node.Get("enctype") == "multipart/form-data");
  start.same_document = false;
  context_->parameters = std::move(parameters);
  ++subdialogs_;
  struct Leave {
    std::size_t& count;
    ~Leave() { --count; }
  } leave{subdialogs_};
  try {
    RunContext(std::move(start));
  } catch (const ReturnToCaller& back) {
    if (back.is_event) throw EventThrown(back.event);
    const Value result = engine_.Object();
    for (const auto& [name, value] : back.values) {
      const std::size_t dot = name.rfind('.');
      engine_.Set(result, dot == std::string::npos ? name : name.substr(dot + 1), value);
    }
    return FillPlain(item, result);
  }
  // The subdialog ran out of things to do: as an <exit>, the whole session ends.
  throw ExitSession{"end"};
}

void DialogSession::VisitObject(Item& item) {
  // This platform has no objects; the event's name is fixed by VoiceXML 2.0 section 2.3.5.
  ThrowEvent("error.unsupported.objectname", "no object '" + item.node->Get("classid") + "'");
}

/// A recording as a script sees it; <audio>, <value> and submitting take it.
Value DialogSession::RecordingObject(const std::string& uri, const std::string& type,
                                     Millis duration) {
  const Value recording = engine_.Object();
  engine_.Set(recording, "uri", engine_.String(uri));
  engine_.Set(recording, "type", engine_.String(type));
  engine_.Set(recording, "duration", engine_.Number(static_cast<double>(duration.count())));
  return recording;
}

bool DialogSession::IsRecording(const Value& value) {
  return engine_.Has(value, "uri") && engine_.Has(value, "duration") && engine_.Has(value, "type");
}

void DialogSession::VisitRecord(Item& item) {
  const vm::xml::Node& node = *item.node;
  if (hung_up_ || disconnected_) throw ExitSession{"hangup"};
  const bool modal = node.Get("modal", "true") == "true";
  const std::vector<ActiveGrammar> active = ActiveGrammars(item, modal);
  RecordRequest request;
  request.listen = MakeListen(item, active);
  request.beep = node.Get("beep", "false") == "true";
  request.dtmf_term = node.Get("dtmfterm", "true") == "true";
  if (const auto time = ParseTime(node.Get("maxtime"))) request.max_time = *time;
  if (const auto time = ParseTime(node.Get("finalsilence"))) request.final_silence = *time;
  request.type = node.Get("type", "audio/x-wav");
  static constexpr std::string_view kTypes =
      "audio/basic audio/x-alaw-basic audio/x-wav audio/wav audio/vnd.wave audio/mpeg";
  const auto types = SplitWords(kTypes);
  const std::string plain = request.type.substr(0, request.type.find(';'));
  if (std::find(types.begin(), types.end(), plain) == types.end()) {
    ThrowEvent("error.unsupported.format", "recording as '" + request.type + "'");
  }
  std::vector<Prompt> queue = std::exchange(queue_, {});
  const RecordResult result = platform_.Record(queue, request);
  budget_.Renew();
  if (result.kind == RecordResult::Kind::kSilence) ThrowEvent("noinput");
  if (result.kind == RecordResult::Kind::kUnsupported) ThrowEvent("error.unsupported.record");
  if (result.kind == RecordResult::Kind::kBadFormat) {
    ThrowEvent("error.unsupported.format", "recording as '" + request.type + "'");
  }
  const auto keep = [&](const std::string& termchar) {
    const Value recording = RecordingObject(result.uri, plain, result.duration);
    const Value shadow = engine_.Object();
    engine_.Set(shadow, "duration", engine_.Number(static_cast<double>(result.duration.count())));
    engine_.Set(shadow, "size", engine_.Number(static_cast<double>(result.bytes)));
    engine_.Set(shadow, "termchar", termchar.empty() ? engine_.Null() : engine_.String(termchar));
    engine_.Set(shadow, "maxtime", engine_.Boolean(result.reached_max));
    Store(item.name + "$", shadow);
    return recording;
  };
  if (result.kind == RecordResult::Kind::kHangup) {
    hung_up_ = true;
    if (result.duration.count() > 0) Store(item.name, keep(""));
    ThrowEvent("connection.disconnect.hangup");
  }
  if (result.kind == RecordResult::Kind::kInput) {
    const Match match = HandleInput(result.input, active);
    if (match.owner != Match::Owner::kItem) return TakeMatch(match, &item);
    const Value recording = keep(match.dtmf ? match.utterance : "");
    const Value shadow = Variable(item.name + "$");
    engine_.Set(shadow, "utterance", engine_.String(match.utterance));
    engine_.Set(shadow, "inputmode", engine_.String(match.dtmf ? "dtmf" : "voice"));
    engine_.Set(shadow, "confidence", engine_.Number(match.confidence));
    engine_.Set(shadow, "interpretation", match.value);
    return FillPlain(item, recording);
  }
  FillPlain(item, keep(result.termchar));
}

void DialogSession::VisitTransfer(Item& item) {
  const vm::xml::Node& node = *item.node;
  if (hung_up_ || disconnected_) throw ExitSession{"hangup"};
  TransferRequest request;
  request.destination = node.Get("dest");
  if (const std::string* expression = node.Find("destexpr")) {
    request.destination = TextOf(node, *expression);
  }
  request.type = node.Get("type");
  if (const std::string* expression = node.Find("typeexpr"))
    request.type = TextOf(node, *expression);
  if (request.type.empty()) {
    request.type = node.Get("bridge", "false") == "true" ? "bridge" : "blind";
  }
  if (request.type != "bridge" && request.type != "blind" && request.type != "consultation") {
    ThrowEvent("error.unsupported.transfer." + request.type);
  }
  if (const auto time = ParseTime(node.Get("connecttimeout"))) request.connect_timeout = *time;
  if (const auto time = ParseTime(node.Get("maxtime"))) request.max_time = *time;
  if (request.destination.empty()) {
    ThrowEvent("error.connection.baddestination", "a transfer without destination");
  }
  const std::vector<ActiveGrammar> active =
      request.type == "blind" ? std::vector<ActiveGrammar>{} : ActiveGrammars(item, true);
  request.listen = MakeListen(item, active);
  std::vector<Prompt> queue = std::exchange(queue_, {});
  const TransferResult result = platform_.Transfer(queue, request);
  budget_.Renew();
  if (result.outcome.starts_with("connection.") || result.outcome.starts_with("error.")) {
    if (result.outcome.starts_with("connection.disconnect")) hung_up_ = true;
    ThrowEvent(result.outcome);
  }
  const Value shadow = engine_.Object();
  engine_.Set(shadow, "duration",
              engine_.Number(static_cast<double>(result.duration.count()) / 1000.0));
  engine_.Set(shadow, "inputmode", engine_.Undefined());
  engine_.Set(shadow, "utterance", engine_.Undefined());
  std::string outcome = result.outcome;
  if (result.ended_by_input) {
    const Match match = HandleInput(result.input, active);
    engine_.Set(shadow, "inputmode", engine_.String(match.dtmf ? "dtmf" : "voice"));
    engine_.Set(shadow, "utterance", engine_.String(match.utterance));
    outcome = "near_end_disconnect";
  }
  Store(item.name + "$", shadow);
  FillPlain(item, engine_.String(outcome));
}

}  // namespace vxml
