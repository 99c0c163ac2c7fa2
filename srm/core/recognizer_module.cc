#include "srm/core/recognizer_module.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace srm {
namespace {

std::string EscapeXml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

/// "yes[310-620] please[620-1000]": ms from the beginning of the source.
std::string WordTimes(const Ear::Heard& heard) {
  std::string text;
  for (const HeardWord& word : heard.hypothesis.words) {
    text += fmt::format("{}{}[{}-{}]", text.empty() ? "" : " ", word.text,
                        (heard.start + word.start).count(), (heard.start + word.end).count());
  }
  return text;
}

}  // namespace

RecognizerModule::RecognizerModule(vm::Scheduler& scheduler, Options options)
    : scheduler_(scheduler), options_(std::move(options)), slots_("SRM") {
  DeclareRun();
  DeclareListen();
  DeclareGrammar();
  DeclareInput();
  DeclareResult();
}

RecognizerModule::~RecognizerModule() { Shutdown(); }

bool RecognizerModule::Busy() const {
  return (listening_ && source_ && source_->Ends()) || (ear_ && ear_->in_speech()) ||
         no_input_timer_ != 0;
}

void RecognizerModule::Shutdown() {
  for (vm::TimerId* timer : {&no_input_timer_, &over_timer_}) {
    if (*timer != 0) scheduler_.Cancel(std::exchange(*timer, 0));
  }
  source_.reset();
}

// --- engines

vm::Result<Ear*> RecognizerModule::NeedEar() {
  if (ear_) return ear_.get();
  auto decoder = options_.open_decoder();
  if (!decoder) return std::unexpected(decoder.error());
  for (const auto& [word, spoken] : pronunciations_) {
    static_cast<void>((*decoder)->Pronounce(word, spoken));  // was right when it was set
  }
  auto spotter = options_.open_spotter();
  ear_ = std::make_unique<Ear>(
      std::move(*decoder), spotter ? std::move(*spotter) : nullptr, endpoints_,
      Ear::Events{
          .began = [this] { OnBegan(); },
          .partial = [this](const std::string& text) { slots_.Report("Result.partial", text); },
          .ended = [this](const Ear::Heard& heard) { OnEnded(heard); },
          .spotted = [this](const std::string& phrase) { slots_.Report("Spot.heard", phrase); }});
  return ear_.get();
}

vm::Result<void> RecognizerModule::UseGrammars() {
  auto ear = NeedEar();
  if (!ear) return std::unexpected(ear.error());
  std::vector<const Grammar*> grammars;
  for (const std::string& name : active_) grammars.push_back(&grammars_.at(name));
  auto used = (*ear)->Use(grammars);
  grammars_used_ = used.has_value();
  return used;
}

// --- grammars

vm::Result<std::string> RecognizerModule::LoadGrammar(const std::string& name,
                                                      const std::string& text) {
  if (name == "NONE" || !vm::IsSlotName(name)) {
    return vm::Fail(vm::Errc::kBadValue, "'" + name + "' cannot be a grammar's name");
  }
  auto grammar = ParseGrammar(text);
  if (!grammar) return std::unexpected(grammar.error());
  if (!grammars_.contains(name) && grammars_.size() >= kMaxGrammars) {
    return vm::Fail(vm::Errc::kLimit, "more than " + std::to_string(kMaxGrammars) + " grammars");
  }
  grammars_.insert_or_assign(name, std::move(*grammar));
  const bool in_use = std::find(active_.begin(), active_.end(), name) != active_.end();
  if (in_use && grammars_used_) {
    if (auto used = UseGrammars(); !used) return std::unexpected(used.error());
  }
  return name;
}

vm::Result<std::string> RecognizerModule::DropGrammar(const std::string& name) {
  if (!grammars_.contains(name)) {
    return vm::Fail(vm::Errc::kBadValue, "no grammar '" + name + "' is loaded");
  }
  const bool was_active = std::erase(active_, name) > 0;
  grammars_.erase(name);
  if (was_active) {
    if (grammars_used_) static_cast<void>(UseGrammars());
    slots_.Report("Grammar", ActiveNames());
  }
  return name;
}

vm::Result<std::string> RecognizerModule::ActivateGrammars(const vm::SetValue& value) {
  std::vector<std::string> wanted;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string& name = value.word(i);
    if (name == "NONE" && value.size() == 1) break;
    if (!grammars_.contains(name)) {
      return vm::Fail(vm::Errc::kBadValue, "no grammar '" + name + "' is loaded");
    }
    if (std::find(wanted.begin(), wanted.end(), name) == wanted.end()) wanted.push_back(name);
  }
  auto before = std::exchange(active_, std::move(wanted));
  if (source_ && listening_) {
    if (auto used = UseGrammars(); !used) {
      active_ = std::move(before);
      static_cast<void>(UseGrammars());
      return std::unexpected(used.error());
    }
  } else {
    grammars_used_ = false;
  }
  return ActiveNames();
}

std::string RecognizerModule::ActiveNames() const {
  std::string names;
  for (const std::string& name : active_) names += (names.empty() ? "" : " ") + name;
  return names.empty() ? "NONE" : names;
}

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
  if (listening_) {
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
  return source_->Start(
      {.sound = [this](std::span<const std::int16_t> samples) { ear_->Feed(samples); },
       .ended = [this] { OnSourceOver(); },
       .failed =
           [this](const vm::Error& error) {
             slots_.ReportError("Input", error);
             OnSourceOver();
           }});
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
    for (const std::string& word : WordsOf(text.substr(at, end - at))) {
      phrase += (phrase.empty() ? "" : " ") + word;
    }
    if (!phrase.empty()) phrases.push_back(std::move(phrase));
    at = end + 1;
  }
  if (auto used = (*ear)->Spot(phrases); !used) return std::unexpected(used.error());
  return phrases.empty() ? "NONE" : text;
}

// --- listening

void RecognizerModule::StartListening() {
  if (listening_) return;
  listening_ = true;
  slots_.Report("Listen.stat", "LISTENING");
  ArmNoInput();
  if (!source_) return;
  if (auto started = StartSource(); !started) slots_.ReportError("Input", started.error());
}

void RecognizerModule::StopListening() {
  if (!listening_) return;
  listening_ = false;
  if (no_input_timer_ != 0) scheduler_.Cancel(std::exchange(no_input_timer_, 0));
  if (over_timer_ != 0) scheduler_.Cancel(std::exchange(over_timer_, 0));
  source_.reset();
  if (source_name_ != "NONE" && !source_name_.starts_with("wav:")) {
    // A live source is opened again at the next START; a recording is over.
    if (auto again = options_.open_source(source_name_)) source_ = std::move(*again);
  }
  if (!source_) source_name_ = "NONE";
  if (ear_) ear_->Reset();
  slots_.Report("Listen.stat", "OFF");
}

void RecognizerModule::ArmNoInput() {
  if (no_input_timer_ != 0) scheduler_.Cancel(std::exchange(no_input_timer_, 0));
  if (timeout_.count() == 0 || !listening_) return;
  no_input_timer_ = scheduler_.After(timeout_, [this] {
    no_input_timer_ = 0;
    slots_.Report("NoInput", std::to_string(timeout_.count()));
  });
}

void RecognizerModule::SetAgentSpeaking(bool speaking) {
  agent_speaking_ = speaking;
  if (ear_) ear_->set_recognizing(!(agent_speaking_ && half_duplex_));
}

void RecognizerModule::OnBegan() {
  if (no_input_timer_ != 0) scheduler_.Cancel(std::exchange(no_input_timer_, 0));
  slots_.Report("Listen.stat", "SPEECH");
  if (agent_speaking_) {
    slots_.Report("BargeIn", vm::FormatMs(scheduler_.Now() - source_start_));
  }
}

void RecognizerModule::OnEnded(const Ear::Heard& heard) {
  Recognize(heard.hypothesis.text, &heard);
  slots_.Report("Listen.stat", "LISTENING");
  ArmNoInput();
}

void RecognizerModule::Recognize(const std::string& text, const Ear::Heard* heard) {
  const double confidence = heard == nullptr ? 1 : heard->hypothesis.confidence;
  std::string grammar, tag;
  bool matched = active_.empty() && !WordsOf(text).empty();
  for (const std::string& name : active_) {
    if (heard != nullptr && confidence < threshold_) break;
    if (auto meaning = grammars_.at(name).Match(text)) {
      matched = true;
      grammar = name;
      tag = meaning->Joined();
      break;
    }
  }
  const vm::Time now = scheduler_.Now();
  const vm::Time start = heard == nullptr ? now : source_start_ + heard->start;
  std::string xml =
      fmt::format("<result start=\"{}\" end=\"{}\">", vm::FormatMs(start), vm::FormatMs(now));
  if (matched) {
    xml += fmt::format(
        "<candidate rank=\"1\" confidence=\"{:.3g}\" grammar=\"{}\" tag=\"{}\">{}</candidate>",
        confidence, EscapeXml(grammar), EscapeXml(tag), EscapeXml(text));
  }
  xml += "</result>";
  slots_.Report("Result.confidence", fmt::format("{:.3g}", confidence));
  slots_.Report("Result.words", heard == nullptr ? "" : WordTimes(*heard));
  if (matched) {
    slots_.Report("Result.grammar", grammar);
    slots_.Report("Result.tag", tag);
  }
  slots_.Report("Result.xml", xml);
  slots_.Report(matched ? "Result" : "NoMatch", text);
}

}  // namespace srm
