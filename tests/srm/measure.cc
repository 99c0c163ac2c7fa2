// Prints how well the ear hears: not a test, since the figures are for docs/speech.md and depend on
// the machine. Run by hand: srm_measure

#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>

#include "srm/align/phone_aligner.h"
#include "ssm/engines/espeak_engine.h"
#include "ssm/flite/flite_engine.h"

namespace {

using Clock = std::chrono::steady_clock;

/// Seconds of this process's own work, whatever else the machine does.
double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
using Samples = std::vector<std::int16_t>;

constexpr const char* kPhrases[] = {
    "yes please",           "no thank you",     "turn on the light",    "turn off the light",
    "open the window",      "close the window", "what time is it",      "tell me a story",
    "good morning",         "good night",       "call my mother",       "send a message",
    "play some music",      "stop the music",   "where is the station", "i want two apples",
    "three pounds of fish", "how much is it",   "that is all",          "start again",
    "go to the next page",  "read it to me",    "what is the weather",  "book a table for four",
    "change the channel",   "make it louder",   "who are you",          "see you tomorrow",
    "help me please",       "cancel the order"};

// Everyday sentences that share words with the phrases now and then.
constexpr const char* kOthers[] = {"the weather was cold in december",
                                   "my brother lives in another country",
                                   "seven people came to the party",
                                   "she bought a large umbrella",
                                   "computers are getting faster every year",
                                   "we should leave before noon",
                                   "he never drinks coffee in the evening",
                                   "the cat slept under the chair",
                                   "this road leads to the village",
                                   "they were waiting for the bus",
                                   "i have forgotten my password",
                                   "put the books on the shelf",
                                   "the train was late again",
                                   "his answer surprised everybody",
                                   "fresh bread smells wonderful",
                                   "you can see the mountains from here",
                                   "nobody knew what to do",
                                   "the children are playing in the garden",
                                   "our teacher speaks three languages",
                                   "please sign on the dotted line",
                                   "i would rather stay at home",
                                   "the soup needs more salt",
                                   "her grandfather was a sailor",
                                   "it rained during the whole concert",
                                   "the museum opens at ten",
                                   "we ran out of milk",
                                   "this shirt is too small for me",
                                   "did you hear that noise",
                                   "the old bridge was closed for repairs",
                                   "my favourite colour is green",
                                   "the doctor will be back soon",
                                   "they painted the house yellow",
                                   "a bird built its nest there",
                                   "the price has doubled since then",
                                   "i met her on the way to school",
                                   "water boils at one hundred degrees",
                                   "turn left at the second corner",
                                   "open your eyes slowly",
                                   "what a beautiful day",
                                   "call it whatever you like",
                                   "the music was far too loud",
                                   "send him to the other office",
                                   "where have you put my glasses",
                                   "stop worrying about the money",
                                   "two of them were missing",
                                   "how did you find us",
                                   "the light was already red",
                                   "time is running out",
                                   "tell your sister the truth",
                                   "good ideas are rare"};

struct Speech {
  ssm::SpeechPlan plan;
  Samples samples;
};

Speech Say(ssm::SpeechEngine& engine, const std::string& text, const std::string& voice) {
  const std::atomic<bool> never{false};
  auto plan = engine.Plan({{.text = text, .voice = voice}}, never);
  if (!plan) return {};
  ssm::SampleBuffer buffer(ssm::ToFrames(vm::TotalDuration(plan->phonemes)));
  static_cast<void>(engine.Render(*plan, buffer));
  return {std::move(*plan), {buffer.Ready().begin(), buffer.Ready().end()}};
}

/// White noise at a ratio to the speech's power, the same each time.
Samples WithNoise(Samples samples, double ratio_db) {
  double power = 0;
  for (const std::int16_t s : samples) power += static_cast<double>(s) * s;
  const double rms =
      std::sqrt(power / static_cast<double>(samples.size()) / std::pow(10, ratio_db / 10));
  std::uint32_t state = 1;
  for (std::int16_t& s : samples) {
    state = state * 1664525u + 1013904223u;
    const double noise = (static_cast<double>(state >> 8) / (1 << 23) - 1) * rms * std::sqrt(3.0);
    s = static_cast<std::int16_t>(std::lround(std::fmax(-32768, std::fmin(32767, s + noise))));
  }
  return samples;
}

struct Totals {
  double sound_s = 0, work_s = 0, worst_end_ms = 0;
};

srm::Hypothesis Hear(srm::SpeechDecoder& decoder, const Samples& samples, Totals& totals) {
  const double start = CpuSeconds();
  decoder.Begin();
  for (std::size_t at = 0; at < samples.size(); at += 1600) {
    decoder.Feed(std::span(samples).subspan(at, std::min<std::size_t>(1600, samples.size() - at)));
  }
  const auto last = Clock::now();
  auto heard = decoder.End();
  const auto end = Clock::now();
  totals.sound_s += static_cast<double>(samples.size()) / 16000;
  totals.work_s += CpuSeconds() - start;
  totals.worst_end_ms =
      std::fmax(totals.worst_end_ms, std::chrono::duration<double, std::milli>(end - last).count());
  return heard;
}

void MeasureAlignment(ssm::SpeechEngine& flite, const char* voice) {
  auto aligner = srm::PhoneAligner::Open(srm::PocketsphinxOptions().model);
  if (!aligner) return;
  std::vector<double> errors;
  double bias = 0, sound_s = 0, work_s = 0, mean = 0;
  int other = 0;
  for (const char* text : kOthers) {
    const Speech speech = Say(flite, text, voice);
    const double start = CpuSeconds();
    const auto found = (*aligner)->Align(speech.samples, text);
    work_s += CpuSeconds() - start;
    sound_s += static_cast<double>(speech.samples.size()) / 16000;
    if (!found || found->phonemes.size() != speech.plan.phonemes.size()) {
      ++other;
      continue;
    }
    double ours = 0, theirs = 0;
    for (std::size_t i = 0; i + 1 < found->phonemes.size(); ++i) {
      ours += static_cast<double>(found->phonemes[i].duration.count());
      theirs += static_cast<double>(speech.plan.phonemes[i].duration.count());
      errors.push_back(std::abs(ours - theirs));
      bias += ours - theirs;
      mean += std::abs(ours - theirs);
    }
  }
  std::sort(errors.begin(), errors.end());
  const auto n = static_cast<double>(errors.size());
  const auto within = std::upper_bound(errors.begin(), errors.end(), 50.0) - errors.begin();
  std::printf(
      "align %s: %zu boundaries, median %.0f ms, mean %.1f ms, bias %.1f ms, within 50 ms "
      "%.1f %%, rtf %.3f; other pronunciation in %d of 50\n",
      voice, errors.size(), errors[errors.size() / 2], mean / n, bias / n,
      100.0 * static_cast<double>(within) / n, work_s / sound_s, other);
}

}  // namespace

int main() {
  auto flite = ssm::MakeFliteEngine();
  auto espeak = ssm::MakeEspeakEngine({.helper = GALATEA_BIN_DIR "/ssm_espeak"});
  auto decoder = srm::OpenPocketsphinx({});
  if (!decoder) {
    std::printf("%s\n", decoder.error().text.c_str());
    return 1;
  }
  std::string text;
  for (const char* phrase : kPhrases) text += std::string(phrase) + "\n";
  const auto grammar = srm::ParseGrammar(text);
  static_cast<void>((*decoder)->Use({&*grammar}));
  Totals totals;
  for (const char* voice : {"slt", "rms", "awb", "kal16", "espeak-en", "espeak-en-gb"}) {
    const bool other = std::string(voice).starts_with("espeak");
    int clean = 0, rejected = 0, noisy = 0;
    double worst = 0;
    for (const char* phrase : kPhrases) {
      const Speech speech = Say(other ? *espeak : *flite, phrase, voice);
      const auto heard = Hear(**decoder, speech.samples, totals);
      clean += heard.text == phrase;
      rejected += heard.text == phrase && heard.confidence < 0.5;
      worst = std::fmin(worst, heard.text == phrase ? heard.fit : 0);
      noisy += Hear(**decoder, WithNoise(speech.samples, 20), totals).text == phrase;
    }
    std::printf("%-13s %d/30 right, %d of them rejected; 20 dB noise %d/30; worst fit %.1f\n",
                voice, clean, rejected, noisy, worst);
    std::fflush(stdout);
  }
  int accepted = 0;
  for (const char* other : kOthers) {
    const auto heard = Hear(**decoder, Say(*flite, other, "slt").samples, totals);
    if (!heard.text.empty() && heard.fit > srm::kFitThreshold - 6) {
      accepted += heard.confidence >= 0.5;
      std::printf("  near: %s -> %s (%.1f)\n", other, heard.text.c_str(), heard.fit);
    }
  }
  std::printf("out of grammar: %d of 50 accepted\nrtf %.3f, longest end of utterance %.1f ms\n",
              accepted, totals.work_s / totals.sound_s, totals.worst_end_ms);
  std::fflush(stdout);
  MeasureAlignment(*flite, "slt");
  MeasureAlignment(*flite, "rms");
  return 0;
}
