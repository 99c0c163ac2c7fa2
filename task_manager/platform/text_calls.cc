// Recordings and transfers in text: the script says how long they are and how they end.
#include <algorithm>

#include "task_manager/platform/text_platform.h"
#include "vm_protocol/core/lower_case.h"

namespace vxml {
namespace {

/// tel:, sip: and sips: URIs (RFC 3966, RFC 3261), and numbers without a scheme.
bool IsTelephoneUri(const std::string& uri) {
  const std::string scheme = vm::LowerCase(uri.substr(0, uri.find(':')));
  if (scheme.size() == uri.size()) return true;
  return scheme == "tel" || scheme == "sip" || scheme == "sips";
}

}  // namespace

RecordResult TextPlatform::Record(const std::vector<Prompt>& prompts,
                                  const RecordRequest& request) {
  RecordResult result;
  const Millis start = now_;
  Play(prompts);
  const std::optional<Command> command = Next();
  Millis length(0);
  if (!command || command->kind == Command::Kind::kHangup) {
    result.kind = RecordResult::Kind::kHangup;
    if (command && command->at) length = *command->at - (now_ - start);
    if (length.count() > 0) Keep(length, request, result);
    return result;
  }
  switch (command->kind) {
    case Command::Kind::kRecord:
      length = command->duration;
      result.termchar = command->word;
      break;
    case Command::Kind::kDtmf:
      length = Millis(1000);
      result.termchar = command->hypotheses.front().text.substr(0, 1);
      break;
    case Command::Kind::kSay: {
      Segment words;
      words.text = command->hypotheses.front().text;
      length = DurationOf(words);
      if (request.listen.accepts && request.listen.accepts(words.text)) {
        result.kind = RecordResult::Kind::kInput;
        result.input.kind = Input::Kind::kSpeech;
        result.input.hypotheses = command->hypotheses;
      }
      break;
    }
    default:
      break;
  }
  if (length.count() == 0) {
    now_ += request.listen.timeout;
    result.kind = RecordResult::Kind::kSilence;
    return result;
  }
  if (!result.termchar.empty()) {
    const KeysState state = request.listen.keys(result.termchar);
    if (state.complete) {
      result.kind = RecordResult::Kind::kInput;
      result.input.kind = Input::Kind::kDtmf;
      result.input.hypotheses = {{result.termchar, 1.0}};
    } else if (!request.dtmf_term) {
      result.termchar.clear();
    }
  }
  Keep(length, request, result);
  return result;
}

/// What was recorded lasts `length`, or as long as may be recorded.
void TextPlatform::Keep(Millis length, const RecordRequest& request, RecordResult& result) {
  result.reached_max = length >= request.max_time;
  result.duration = std::min(length, request.max_time);
  if (result.reached_max) result.termchar.clear();
  now_ += result.duration;
  result.bytes = static_cast<std::size_t>(result.duration.count()) * 8;  // 8 kHz, 8 bit
  JsonLine line;
  line.Number("ms", static_cast<double>(result.duration.count())).Text("termchar", result.termchar);
  Report("recorded", line);
}

TransferResult TextPlatform::Transfer(const std::vector<Prompt>& prompts,
                                      const TransferRequest& request) {
  TransferResult result;
  if (!IsTelephoneUri(request.destination)) {
    result.outcome = "error.unsupported.uri";
    return result;
  }
  Play(prompts);
  std::optional<Command> command = Next();
  JsonLine line;
  line.Text("dest", request.destination).Text("kind", request.type);
  Report("transfer", line);
  if (!command) {
    result.outcome =
        request.type == "blind" ? "connection.disconnect.transfer" : "connection.disconnect.hangup";
    return result;
  }
  result.duration = command->duration;
  switch (command->kind) {
    case Command::Kind::kTransfer:
      result.outcome = command->word;
      break;
    case Command::Kind::kHangup:
      result.outcome = "connection.disconnect.hangup";
      break;
    case Command::Kind::kSay:
    case Command::Kind::kDtmf: {
      const bool keys = command->kind == Command::Kind::kDtmf;
      const std::string text = command->hypotheses.front().text;
      const bool match = keys ? request.listen.keys(text).complete : request.listen.accepts(text);
      result.outcome = "far_end_disconnect";
      if (match) {
        result.ended_by_input = true;
        result.input.kind = keys ? Input::Kind::kDtmf : Input::Kind::kSpeech;
        result.input.hypotheses = command->hypotheses;
      }
      break;
    }
    default:
      result.outcome = "noanswer";
  }
  if (request.max_time.count() > 0 && result.duration >= request.max_time &&
      result.outcome == "far_end_disconnect") {
    result.duration = request.max_time;
    result.outcome = "maxtime_disconnect";
  }
  now_ += result.duration;
  return result;
}

}  // namespace vxml
