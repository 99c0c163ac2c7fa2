#include "task_manager/interpreter/recognition.h"

#include <algorithm>

#include "task_manager/grammar/matcher.h"
#include "task_manager/grammar/phrases.h"
#include "task_manager/grammar/semantics.h"

namespace vxml {

using script::Value;
using ActiveList = std::vector<ActiveGrammar>;

namespace {

/// The voice grammars as phrases for the ear; "" if one cannot be written so, or all are too long.
std::string PhrasesOf(const ActiveList& active, std::size_t most_bytes) {
  std::string all;
  for (const ActiveGrammar& grammar : active) {
    if (grammar.IsDtmf()) continue;
    const auto text = srgs::ToPhrases(*grammar.rule, most_bytes);
    if (!text || all.size() + text->size() + 3 > most_bytes) return "";
    all += (all.empty() ? "" : " | ") + *text;
  }
  return all;
}

KeysState StateOf(const ActiveList& active, const std::string& keys) {
  KeysState state;
  for (const ActiveGrammar& grammar : active) {
    if (!grammar.IsDtmf()) continue;
    const srgs::MatchResult match = srgs::Match(*grammar.rule, keys);
    state.complete = state.complete || match.parse != nullptr;
    state.can_continue = state.can_continue || match.can_continue;
  }
  return state;
}

}  // namespace

Listen Recognition::MakeListen(const FormItem& item, const ActiveList& active) const {
  const Properties& properties = rt_.properties;
  Listen listen;
  const std::string modes = properties.Get("inputmodes");
  listen.voice = modes.find("voice") != std::string::npos;
  listen.dtmf = modes.find("dtmf") != std::string::npos;
  listen.timeout = properties.Time("timeout", Millis(5000));
  listen.hotword = properties.Is("bargeintype", "hotword");
  for (const Prompt& prompt : queue_.prompts()) {  // the last one counts
    if (prompt.IsNative()) continue;
    listen.timeout = prompt.timeout.value_or(properties.Time("timeout", Millis(5000)));
    listen.hotword = prompt.hotword;
  }
  listen.interdigit_timeout = properties.Time("interdigittimeout", Millis(3000));
  listen.term_timeout = properties.Time("termtimeout", Millis(0));
  listen.max_speech = properties.Time("maxspeechtimeout", Millis(20000));
  listen.termchar = properties.Get("termchar");
  listen.language = rt_.position.LanguageAt(*item.node);
  listen.item = item.name;
  listen.attention = !properties.Is("attention", "false");
  listen.keep_sound = properties.Is("recordutterance", "true");
  listen.keys = [&active](const std::string& keys) { return StateOf(active, keys); };
  listen.phrases = [&active](std::size_t most_bytes) { return PhrasesOf(active, most_bytes); };
  listen.accepts = [&active](const std::string& words) {
    return std::ranges::any_of(active, [&](const ActiveGrammar& grammar) {
      return !grammar.IsDtmf() && srgs::Match(*grammar.rule, words).parse;
    });
  };
  return listen;
}

std::optional<Match> Recognition::MatchText(const std::string& text, bool dtmf,
                                            const ActiveList& active) {
  for (const ActiveGrammar& grammar : active) {
    if (grammar.IsDtmf() != dtmf) continue;
    rt_.budget.Step(0);
    const srgs::MatchResult found = srgs::Match(*grammar.rule, text);
    if (!found.parse) continue;
    auto value = srgs::Interpret(rt_.engine, *found.parse, text);
    JsonLine line;
    line.Text("input", text).Text("parse", found.parse->Format());
    line.Text("owner", grammar.node ? grammar.node->name : "platform");
    line.Number("line", grammar.node ? static_cast<double>(grammar.node->line) : 0);
    if (!value) line.Text("error", value.error().text);
    rt_.Trace("match", line);
    rt_.budget.Step(0);
    if (!value) {
      const bool limit = value.error().code == vm::Errc::kLimit;
      ThrowEvent(limit ? "error.noresource" : "error.semantic", value.error().text);
    }
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

std::vector<Match> Recognition::MatchesOf(const Input& input, const ActiveList& active,
                                          bool& below_confidence) {
  const bool dtmf = input.kind == Input::Kind::kDtmf;
  const double threshold = dtmf ? 0 : rt_.properties.Number("confidencelevel", 0, 1, 0.5);
  const auto most = static_cast<std::size_t>(rt_.properties.Number("maxnbest", 1, 1000, 1));
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

std::vector<Match> Recognition::HeardIn(const Input& input) const {
  std::vector<Match> heard;
  for (const Hypothesis& hypothesis : input.hypotheses) {
    Match& match = heard.emplace_back();
    match.utterance = vm::xml::Collapse(hypothesis.text);
    match.confidence = hypothesis.confidence;
  }
  if (heard.empty()) heard.emplace_back().confidence = 0;
  for (Match& match : heard) match.dtmf = input.kind == Input::Kind::kDtmf;
  return heard;
}

void Recognition::Describe(const Value& into, const Match& match) const {
  script::Engine& engine = rt_.engine;
  engine.Set(into, "utterance", engine.String(match.utterance));
  engine.Set(into, "confidence", engine.Number(match.confidence));
  engine.Set(into, "inputmode", engine.String(match.dtmf ? "dtmf" : "voice"));
  engine.Set(into, "interpretation", match.value);
}

/// application.lastresult$ (VoiceXML 2.0 section 5.1.5).
void Recognition::SetLastResult(const std::vector<Match>& matches, const Input& input) {
  script::Engine& engine = rt_.engine;
  const Value last = engine.Array();
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Value entry = engine.Object();
    Describe(entry, matches[i]);
    engine.Set(last, std::to_string(i), entry);
  }
  Describe(last, matches.front());
  if (!input.mark.empty()) {
    engine.Set(last, "markname", engine.String(input.mark));
    engine.Set(last, "marktime", engine.Number(static_cast<double>(input.mark_time.count())));
  }
  if (rt_.properties.Is("recordutterance", "true") && input.recorded.count() > 0) {
    const auto duration = static_cast<double>(input.recorded.count());
    const double bytes = input.recorded_bytes > 0 ? static_cast<double>(input.recorded_bytes)
                                                  : duration * 8;  // 8 kHz, 8 bit
    engine.Set(last, "recording",
               MakeRecording(engine, input.recording, rt_.properties.Get("recordutterancetype"),
                             input.recorded));
    engine.Set(last, "recordingsize", engine.Number(bytes));
    engine.Set(last, "recordingduration", engine.Number(duration));
  }
  rt_.scopes.SetLastResult(last);
}

Match Recognition::Interpret(const Input& input, const ActiveList& active) {
  if (input.kind == Input::Kind::kSilence) ThrowEvent("noinput");
  if (input.kind == Input::Kind::kTooLong) ThrowEvent("maxspeechtimeout");
  if (input.kind == Input::Kind::kHangup) rt_.connection.HangUp();
  bool below = false;
  std::vector<Match> matches = MatchesOf(input, active, below);
  JsonLine line;
  line.Text("mode", input.kind == Input::Kind::kDtmf ? "dtmf" : "voice");
  line.Text("utterance", input.hypotheses.empty() ? "" : input.hypotheses.front().text);
  line.Bool("match", !matches.empty());
  if (matches.empty()) {
    if (below) line.Bool("below_confidencelevel", true);
    rt_.platform.Report("result", line);
    SetLastResult(HeardIn(input), input);  // a nomatch counts as a recognition
    ThrowEvent("nomatch");
  }
  line.Number("confidence", matches.front().confidence);
  line.Raw("interpretation", rt_.engine.ToJson(matches.front().value));
  rt_.platform.Report("result", line);
  SetLastResult(matches, input);
  return matches.front();
}

}  // namespace vxml
