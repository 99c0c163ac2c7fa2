// How near `align` comes to the times the synthesiser itself gives, and beside Rhubarb Lip Sync on
// the same files where its program `rhubarb` is on the path. Prints a table for each voice:
//   alignment_bench [VOICE...]

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>

#include "bench/closures.h"
#include "bench/rhubarb_peer.h"
#include "bench/speech_material.h"
#include "srm/align/phone_aligner.h"
#include "ssm/engines/wav_piece.h"
#include "ssm/flite/flite_engine.h"
#include "ssm/voice/wav_file.h"

namespace {

using speech_bench::Closures;
using speech_bench::Interval;
using speech_bench::Speech;

std::vector<Interval> Intervals(const vm::PhonemeList& phonemes) {
  std::vector<Interval> list;
  double at = 0;
  for (const vm::Phoneme& phoneme : phonemes) {
    const auto ms = static_cast<double>(phoneme.duration.count());
    list.push_back({at, at + ms, phoneme.name == "ax" ? "ah" : phoneme.name});
    at += ms;
  }
  return list;
}

/// Which of `ours` stands for which of `theirs`, by least edits; -1 = none.
std::vector<int> Partners(const std::vector<Interval>& theirs, const std::vector<Interval>& ours) {
  const std::size_t n = theirs.size(), m = ours.size();
  std::vector<int> table((n + 1) * (m + 1));
  const auto cost = [&](std::size_t i, std::size_t j) -> int& { return table[i * (m + 1) + j]; };
  for (std::size_t i = 0; i <= n; ++i) {
    for (std::size_t j = 0; j <= m; ++j) {
      if (i == 0 || j == 0) {
        cost(i, j) = static_cast<int>(i + j);
      } else {
        const int same = cost(i - 1, j - 1) + (theirs[i - 1].name == ours[j - 1].name ? 0 : 1);
        cost(i, j) = std::min({same, cost(i - 1, j) + 1, cost(i, j - 1) + 1});
      }
    }
  }
  std::vector<int> partner(n, -1);
  for (std::size_t i = n, j = m; i > 0 && j > 0;) {
    const bool same = theirs[i - 1].name == ours[j - 1].name;
    if (cost(i, j) == cost(i - 1, j - 1) + (same ? 0 : 1)) {
      if (same) partner[i - 1] = static_cast<int>(j - 1);
      --i, --j;
    } else if (cost(i, j) == cost(i - 1, j) + 1) {
      --i;
    } else {
      --j;
    }
  }
  return partner;
}

struct Figures {
  std::vector<double> errors;  // of boundaries whose phonemes on both sides agree
  double bias = 0, sound_s = 0, work_s = 0;
  std::size_t boundaries = 0;  // the truth's
  Closures closures;
  std::map<std::string, int> far;  // boundaries off by more than 50 ms, by their phonemes

  void Add(const std::vector<Interval>& theirs, const std::vector<Interval>& ours) {
    const std::vector<int> partner = Partners(theirs, ours);
    boundaries += theirs.size() - 1;
    for (std::size_t i = 0; i + 1 < theirs.size(); ++i) {
      if (partner[i] < 0 || partner[i + 1] != partner[i] + 1) continue;
      const double error = ours[static_cast<std::size_t>(partner[i])].end - theirs[i].end;
      errors.push_back(std::abs(error));
      bias += error;
      if (std::abs(error) > 50)
        ++far[theirs[i].name + (error > 0 ? " > " : " < ") + theirs[i + 1].name];
    }
    std::vector<Interval> closed;
    for (const Interval& one : ours) {
      if (speech_bench::IsClosure(one.name)) closed.push_back(one);
    }
    closures.Add(theirs, closed);
  }
};

/// One line of a voice's table; "n/a" where somebody has no such figure.
void Line(const char* what, const std::string& ours, const std::string& theirs, const char* goal) {
  std::printf("  %-34s %12s %12s %8s\n", what, ours.c_str(), theirs.c_str(), goal);
}

/// `theirs`: null where the peer is not on the path.
void Print(const std::string& voice, Figures& figures, const Closures* theirs, double peer_s) {
  std::sort(figures.errors.begin(), figures.errors.end());
  const auto n = static_cast<double>(figures.errors.size());
  double sum = 0;
  for (const double error : figures.errors) sum += error;
  const auto within =
      std::upper_bound(figures.errors.begin(), figures.errors.end(), 50.0) - figures.errors.begin();
  const std::string none = "n/a";
  const auto hits = [](const Closures& closures) {
    return fmt::format("{} of {}", closures.hit, closures.all);
  };
  std::printf("%-36s %12s %12s %8s\n", voice.c_str(), "align", "rhubarb", "goal");
  Line("boundaries whose phonemes agree",
       fmt::format("{}/{}", figures.errors.size(), figures.boundaries), none, "");
  Line("median error, ms", fmt::format("{:.1f}", figures.errors[figures.errors.size() / 2]), none,
       "12");
  Line("mean error, ms", fmt::format("{:.1f}", sum / n), none, "25");
  Line("late by, ms", fmt::format("{:.1f}", figures.bias / n), none, "");
  Line("within 50 ms", fmt::format("{:.1f} %", 100.0 * static_cast<double>(within) / n), none,
       "98 %");
  Line("closures of p, b, m hit", hits(figures.closures), theirs ? hits(*theirs) : none, "95 %");
  Line("their beginning, mean error, ms", fmt::format("{:.1f}", figures.closures.mean_error()),
       theirs ? fmt::format("{:.1f}", theirs->mean_error()) : none, "25");
  Line("processor time by sound's time", fmt::format("{:.3f}", figures.work_s / figures.sound_s),
       theirs ? fmt::format("{:.3f}", peer_s / figures.sound_s) : none, "0.04");
  if (std::getenv("FAR") != nullptr) {
    for (const auto& [pair, count] : figures.far) std::printf("   %s: %d\n", pair.c_str(), count);
  }
  std::fflush(stdout);
}

bool Measure(const std::string& voice) {
  auto flite = ssm::MakeFliteEngine();
  auto aligner = srm::PhoneAligner::Open(srm::PocketsphinxOptions().model);
  if (!aligner) {
    std::printf("%s\n", aligner.error().text.c_str());
    return false;
  }
  Figures ours;
  Closures peers;
  speech_bench::Peer peer;
  const bool has_peer = speech_bench::IsOnPath(peer.program);
  const ssm::TemporaryFolder folder;
  for (const auto* list : {&speech_bench::OtherSentences(), &speech_bench::Phrases()}) {
    for (const std::string& text : *list) {
      const Speech speech = speech_bench::Say(*flite, text, voice);
      const std::vector<Interval> truth = Intervals(speech.plan.phonemes);
      const double start = speech_bench::CpuSeconds();
      const auto found = (*aligner)->Align(speech.samples, text);
      ours.work_s += speech_bench::CpuSeconds() - start;
      ours.sound_s += speech_bench::SoundSeconds(speech.samples);
      if (found) ours.Add(truth, Intervals(found->phonemes));
      if (!has_peer) continue;
      const std::string wav = folder.File("a.wav"), dialog = folder.File("a.txt");
      std::ofstream(dialog) << text << "\n";
      if (!ssm::WriteWav(wav, speech.samples)) return false;
      auto closed = peer.Closed(wav, dialog);
      if (!closed) {
        std::printf("%s\n", closed.error().text.c_str());
        return false;
      }
      peers.Add(truth, *closed);
    }
  }
  Print(voice, ours, has_peer ? &peers : nullptr, peer.work_s);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> usual = {"slt", "rms", "kal16"};
  for (const std::string& voice :
       argc > 1 ? std::vector<std::string>(argv + 1, argv + argc) : usual) {
    if (!Measure(voice)) return 1;
  }
  if (!speech_bench::IsOnPath(speech_bench::Peer{}.program)) {
    std::printf("n/a: Rhubarb Lip Sync (program rhubarb) is not on the path\n");
  }
  return 0;
}
