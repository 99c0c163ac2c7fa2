// The module while it listens: sound, interruptions, what was said.

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <utility>

#include "ear/result_report.h"
#include "embedded/srm_unfinished.h"
#include "srm/core/recognizer_module.h"

namespace srm {
namespace {

/// "yes[310-620] please[620-1000]": ms from the beginning of the source.
std::string WordTimes(const Ear::Heard& heard) {
  std::string text;
  for (const HeardWord& word : heard.hypothesis.words) {
    text += fmt::format("{}{}[{}-{}]", text.empty() ? "" : " ", word.text,
                        (heard.start + word.start).count(), (heard.start + word.end).count());
  }
  return text;
}

/// "yes 0.93 please 0.71".
std::string WordConfidences(const Ear::Heard& heard) {
  std::string text;
  for (const HeardWord& word : heard.hypothesis.words) {
    text += fmt::format("{}{} {:.2f}", text.empty() ? "" : " ", word.text, word.confidence);
  }
  return text;
}

/// Words of a text that was heard: the engine's stand-in for any word is one of them.
std::vector<std::string> HeardWords(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    at = end + 1;
    if (word == ear::kNotUnderstood) {
      words.push_back(word);
    } else {
      for (std::string& one : ear::WordsOf(word)) words.push_back(std::move(one));
    }
  }
  return words;
}

/// Of srm/tables/unfinished.txt.
const std::set<std::string, std::less<>>& UnfinishedWords() {
  static const auto words = [] {
    std::set<std::string, std::less<>> read;
    std::istringstream lines{std::string(embedded::srm_unfinished())};
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with('#')) continue;
      std::istringstream row(line);
      for (std::string word; row >> word;) read.insert(word);
    }
    return read;
  }();
  return words;
}

/// "0.93 yes please | 0.41 yes": what fits, best first.
std::string NBest(const ear::ResultReport& report) {
  std::string text;
  for (const ear::Candidate& candidate : report.candidates) {
    text +=
        fmt::format("{}{:.2f} {}", text.empty() ? "" : " | ", candidate.confidence, candidate.text);
  }
  return text;
}

}  // namespace

// --- sound

vm::Result<std::string> RecognizerModule::SetInput(const std::string& name) {
  source_.reset();
  if (ear_) ear_->Reset();
  source_name_ = "NONE";
  if (name == "NONE") return name;
  auto source = options_.open_source(name);
  if (!source) return std::unexpected(source.error());
  source_ = std::move(*source);
  source_name_ = name;
  if (listening_.on()) {
    if (auto started = StartSource(); !started) {
      source_.reset();
      source_name_ = "NONE";
      return std::unexpected(started.error());
    }
  }
  return name;
}

vm::Result<void> RecognizerModule::StartSource() {
  if (!grammars_used_) {
    if (auto used = UseGrammars(); !used) return used;
  }
  source_start_ = scheduler_.Now();
  // The voice first: what it plays is known before the microphone hears it.
  if (auto started = StartVoice(); !started) slots_.ReportError("Agent.voice", started.error());
  return source_->Start({.sound = [this](std::span<const std::int16_t> samples) { Hear(samples); },
                         .ended = [this] { OnSourceOver(); },
                         .failed =
                             [this](const vm::Error& error) {
                               slots_.ReportError("Input", error);
                               OnSourceOver();
                             }});
}

void RecognizerModule::Hear(std::span<const std::int16_t> samples) {
  ear_->settings().longest = listening_.longest();
  if (!canceller_) return ear_->Feed(samples);
  const std::vector<std::int16_t> clean = canceller_->Clean(samples);
  if (!clean.empty()) ear_->Feed(clean);
}

vm::Result<std::string> RecognizerModule::SetVoice(const std::string& name) {
  voice_.reset();
  voice_name_ = "NONE";
  if (name == "NONE") return name;
  auto source = options_.open_source(name);
  if (!source) return std::unexpected(source.error());
  voice_ = std::move(*source);
  voice_name_ = name;
  if (source_ && listening_.on()) {
    if (auto started = StartVoice(); !started) return std::unexpected(started.error());
  }
  return name;
}

vm::Result<void> RecognizerModule::StartVoice() {
  if (!voice_) return {};
  const auto over = [this] { voice_name_ = "NONE"; };
  return voice_->Start({.sound =
                            [this](std::span<const std::int16_t> samples) {
                              if (canceller_) canceller_->Play(samples);
                            },
                        .ended = over,
                        .failed =
                            [this, over](const vm::Error& error) {
                              slots_.ReportError("Agent.voice", error);
                              over();
                            }});
}

void RecognizerModule::SetEcho(Echo echo) {
  echo_ = echo;
  if (echo != Echo::kCancel)
    canceller_.reset();
  else if (!canceller_)
    canceller_ = std::make_unique<EchoCanceller>();
  SetAgentSpeaking(agent_speaking_);
}

/// The source may be in the middle of a call, so it goes a little later.
void RecognizerModule::OnSourceOver() {
  over_timer_ = scheduler_.Post([this] {
    over_timer_ = 0;
    ear_->Finish();
    source_.reset();
    source_name_ = "NONE";
    slots_.Report("Input", "NONE");
  });
}

vm::Result<std::string> RecognizerModule::SetSpot(const std::string& text) {
  auto ear = NeedEar();
  if (!ear) return std::unexpected(ear.error());
  std::vector<std::string> phrases;
  for (std::size_t at = 0; at <= text.size() && text != "NONE";) {
    const std::size_t end = std::min(text.find('|', at), text.size());
    std::string phrase;
    for (const std::string& word : ear::WordsOf(text.substr(at, end - at))) {
      phrase += (phrase.empty() ? "" : " ") + word;
    }
    if (!phrase.empty()) phrases.push_back(std::move(phrase));
    at = end + 1;
  }
  if (auto used = (*ear)->Spot(phrases); !used) return std::unexpected(used.error());
  return phrases.empty() ? "NONE" : text;
}

// --- listening

void RecognizerModule::StopListening() {
  if (over_timer_ != 0) scheduler_.Cancel(std::exchange(over_timer_, 0));
  source_.reset();
  voice_.reset();
  if (voice_name_ != "NONE" && !voice_name_.starts_with("wav:")) {
    if (auto again = options_.open_source(voice_name_)) voice_ = std::move(*again);
  }
  if (!voice_) voice_name_ = "NONE";
  if (source_name_ != "NONE" && !source_name_.starts_with("wav:")) {
    // A live source is opened again at the next START; a recording is over.
    if (auto again = options_.open_source(source_name_)) source_ = std::move(*again);
  }
  if (!source_) source_name_ = "NONE";
  if (ear_) ear_->Reset();
  if (options_.transcriber) options_.transcriber->Abandon();
}

void RecognizerModule::SetAgentSpeaking(bool speaking) {
  agent_speaking_ = speaking;
  if (ear_) ear_->set_recognizing(!(agent_speaking_ && echo_ == Echo::kHalf));
}

void RecognizerModule::OnBegan() {
  listening_.Hear();
  if (agent_speaking_) {
    slots_.Report("BargeIn", vm::FormatMs(scheduler_.Now() - source_start_));
  }
}

void RecognizerModule::OnEnded(const Ear::Heard& heard) {
  keep_.Keep(heard.sound, heard.longest);
  const vm::Time now = scheduler_.Now();
  if (!options_.transcriber) {
    Recognize(heard.hypothesis.text, &heard, now);
    return listening_.Wait();
  }
  listening_.Wait(true);  // patience begins with the answer
  const auto told = [this, now, start = heard.start](const vm::Result<Hypothesis>& hypothesis) {
    if (!hypothesis) slots_.ReportError("Result", hypothesis.error());
    const Ear::Heard words{.hypothesis = hypothesis.value_or(Hypothesis{}), .start = start};
    Recognize(words.hypothesis.text, &words, now);
    if (!ear_->in_speech() && !options_.transcriber->Busy()) listening_.Arm();
  };
  if (auto sent = options_.transcriber->Transcribe(heard.sound, told); !sent) {
    told(std::unexpected(sent.error()));
  }
}

void RecognizerModule::Recognize(const std::string& text, const Ear::Heard* heard, vm::Time end) {
  const double confidence = heard == nullptr ? 1 : heard->hypothesis.confidence;
  ear::ResultReport report{.start = heard == nullptr ? end : source_start_ + heard->start,
                           .end = end};
  if (auto best = Understand(text, confidence)) {
    report.candidates.push_back(std::move(*best));
    // Another hypothesis counts where it fits, whatever its confidence.
    for (const Alternative& other :
         heard == nullptr ? std::vector<Alternative>() : heard->hypothesis.others) {
      if (auto next = Understand(other.text, other.confidence)) {
        report.candidates.push_back(std::move(*next));
      }
    }
    if (heard != nullptr && confidence < threshold_) report.candidates.clear();
  }
  slots_.Report("Result.confidence", fmt::format("{:.3g}", confidence));
  slots_.Report("Result.words", heard == nullptr ? "" : WordTimes(*heard));
  slots_.Report("Result.wordconfidence", heard == nullptr ? "" : WordConfidences(*heard));
  slots_.Report("Result.nbest", NBest(report));
  ear::TellResult(slots_, report, text);
}

bool RecognizerModule::IsWhole(const std::string& text) const {
  if (!grammars_.active().empty()) return Understand(text, 1).has_value();
  const std::vector<std::string> words = HeardWords(text);
  return !words.empty() && !UnfinishedWords().contains(words.back());
}

/// What a text means to the first active grammar it fits; without grammars it stands as it is.
std::optional<ear::Candidate> RecognizerModule::Understand(const std::string& text,
                                                           double confidence) const {
  const std::vector<std::string> words = HeardWords(text);
  if (words.empty()) return std::nullopt;
  ear::Candidate candidate{.text = text, .confidence = confidence};
  if (grammars_.active().empty()) return candidate;
  for (const std::string& name : grammars_.active()) {
    if (auto meaning = grammars_.at(name).Match(words)) {
      candidate.grammar = name;
      candidate.tag = meaning->Joined();
      return candidate;
    }
  }
  return std::nullopt;
}

}  // namespace srm
