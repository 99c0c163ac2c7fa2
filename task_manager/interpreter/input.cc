#include <algorithm>
#include <charconv>

#include "task_manager/grammar/matcher.h"
#include "task_manager/grammar/phrases.h"
#include "task_manager/grammar/semantics.h"
#include "task_manager/interpreter/dialog_session.h"

namespace vxml {

using script::Value;

namespace {

bool IsDtmf(const ActiveGrammar& grammar) {
  return grammar.rule->grammar && grammar.rule->grammar->mode == srgs::Mode::kDtmf;
}

double NumberOr(const std::string& text, double otherwise) {
  double value = otherwise;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() ? value : otherwise;
}

}  // namespace

Listen DialogSession::MakeListen(const Item& item, const std::vector<ActiveGrammar>& active) {
  Listen listen;
  const std::string modes = Property("inputmodes");
  listen.voice = modes.find("voice") != std::string::npos;
  listen.dtmf = modes.find("dtmf") != std::string::npos;
  listen.timeout = TimeProperty("timeout", Millis(5000));
  listen.hotword = Property("bargeintype") == "hotword";
  for (const Prompt& prompt : queue_) {  // the last one counts, with or without its own timeout
    if (prompt.text.empty() && !prompt.Plays()) continue;
    listen.timeout = prompt.timeout.value_or(TimeProperty("timeout", Millis(5000)));
    listen.hotword = prompt.hotword;
  }
  listen.interdigit_timeout = TimeProperty("interdigittimeout", Millis(3000));
  listen.term_timeout = TimeProperty("termtimeout", Millis(0));
  listen.max_speech = TimeProperty("maxspeechtimeout", Millis(20000));
  listen.termchar = Property("termchar");
  listen.language = LanguageAt(*item.node);
  listen.item = item.name;
  listen.keys = [&active](const std::string& keys) {
    KeysState state;
    for (const ActiveGrammar& grammar : active) {
      if (!IsDtmf(grammar)) continue;
      const srgs::MatchResult match = srgs::Match(*grammar.rule, keys);
      state.complete = state.complete || match.parse != nullptr;
      state.can_continue = state.can_continue || match.can_continue;
    }
    return state;
  };
  listen.attention = Property("attention") != "false";
  listen.keep_sound = Property("recordutterance") == "true";
  listen.phrases = [&active](std::size_t most_bytes) {
    std::string all;
    for (const ActiveGrammar& grammar : active) {
      if (IsDtmf(grammar)) continue;
      const auto text = srgs::ToPhrases(*grammar.rule, most_bytes);
      if (!text || all.size() + text->size() + 3 > most_bytes) return std::string();
      all += (all.empty() ? "" : " | ") + *text;
    }
    return all;
  };
  listen.accepts = [&active](const std::string& words) {
    for (const ActiveGrammar& grammar : active) {
      if (!IsDtmf(grammar) && srgs::Match(*grammar.rule, words).parse) return true;
    }
    return false;
  };
  return listen;
}

std::optional<Match> DialogSession::MatchText(const std::string& text, bool dtmf,
                                              const std::vector<ActiveGrammar>& active) {
  for (const ActiveGrammar& grammar : active) {
    if (IsDtmf(grammar) != dtmf) continue;
    const srgs::MatchResult found = srgs::Match(*grammar.rule, text);
    if (!found.parse) continue;
    auto value = srgs::Interpret(engine_, *found.parse, text);
    JsonLine line;
    line.Text("input", text).Text("parse", found.parse->Format());
    line.Text("owner", grammar.node ? grammar.node->name : "platform");
    line.Number("line", grammar.node ? static_cast<double>(grammar.node->line) : 0);
    if (!value) line.Text("error", value.error().text);
    Trace("match", line);
    if (!value) ThrowEvent("error.semantic", value.error().text);
    Match match;
    match.owner = grammar.owner;
    match.node = grammar.node;
    match.document = grammar.document;
    match.value = *value;
    match.utterance = text;
    match.dtmf = dtmf;
    return match;
  }
  return {};
}

std::vector<Match> DialogSession::Recognize(const Input& input,
                                            const std::vector<ActiveGrammar>& active,
                                            bool& below_confidence) {
  const bool dtmf = input.kind == Input::Kind::kDtmf;
  const double threshold = dtmf ? 0 : NumberOr(Property("confidencelevel"), 0.5);
  const auto most = static_cast<std::size_t>(std::max(1.0, NumberOr(Property("maxnbest"), 1)));
  std::vector<Match> matches;
  for (const Hypothesis& hypothesis : input.hypotheses) {
    if (matches.size() >= most) break;
    auto match = MatchText(vm::xml::Collapse(hypothesis.text), dtmf, active);
    if (!match) continue;
    match->confidence = hypothesis.confidence;
    if (hypothesis.confidence < threshold) {
      below_confidence = true;
      continue;
    }
    matches.push_back(std::move(*match));
  }
  return matches;
}

/// application.lastresult$ (VoiceXML 2.0 section 5.1.5).
void DialogSession::SetLastResult(const std::vector<Match>& matches, const Input& input) {
  const Value last = engine_.Array();
  const auto fill = [&](const Value& into, const Match& match) {
    engine_.Set(into, "utterance", engine_.String(match.utterance));
    engine_.Set(into, "confidence", engine_.Number(match.confidence));
    engine_.Set(into, "inputmode", engine_.String(match.dtmf ? "dtmf" : "voice"));
    engine_.Set(into, "interpretation", match.value);
  };
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Value entry = engine_.Object();
    fill(entry, matches[i]);
    engine_.Set(last, std::to_string(i), entry);
  }
  if (!matches.empty()) fill(last, matches.front());
  if (!input.mark.empty()) {
    engine_.Set(last, "markname", engine_.String(input.mark));
    engine_.Set(last, "marktime", engine_.Number(static_cast<double>(input.mark_time.count())));
  }
  if (Property("recordutterance") == "true" && input.recorded.count() > 0) {
    const auto duration = static_cast<double>(input.recorded.count());
    const double bytes = input.recorded_bytes > 0 ? static_cast<double>(input.recorded_bytes)
                                                  : duration * 8;  // 8 kHz, 8 bit
    engine_.Set(last, "recording",
                RecordingObject(input.recording, Property("recordutterancetype"), input.recorded));
    engine_.Set(last, "recordingsize", engine_.Number(bytes));
    engine_.Set(last, "recordingduration", engine_.Number(duration));
  }
  engine_.Set(context_->application, "lastresult$", last);
}

/// The best match of what came in; everything else is thrown as its event.
Match DialogSession::HandleInput(const Input& input, const std::vector<ActiveGrammar>& active) {
  switch (input.kind) {
    case Input::Kind::kSilence:
      ThrowEvent("noinput");
    case Input::Kind::kTooLong:
      ThrowEvent("maxspeechtimeout");
    case Input::Kind::kHangup:
      hung_up_ = true;
      ThrowEvent("connection.disconnect.hangup");
    case Input::Kind::kSpeech:
    case Input::Kind::kDtmf:
      break;
  }
  bool below = false;
  std::vector<Match> matches = Recognize(input, active, below);
  JsonLine line;
  line.Text("mode", input.kind == Input::Kind::kDtmf ? "dtmf" : "voice");
  line.Text("utterance", input.hypotheses.empty() ? "" : input.hypotheses.front().text);
  line.Bool("match", !matches.empty());
  if (matches.empty()) {
    if (below) line.Bool("below_confidencelevel", true);
    platform_.Report("result", line);
    ThrowEvent("nomatch");
  }
  line.Number("confidence", matches.front().confidence);
  line.Raw("interpretation", engine_.ToJson(matches.front().value));
  platform_.Report("result", line);
  SetLastResult(matches, input);
  return matches.front();
}

}  // namespace vxml
