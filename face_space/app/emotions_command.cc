#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <stdexcept>

#include "face_space/app/commands.h"
#include "face_space/emotion/space_training.h"
#include "fsm/motion/inputs/motion_tables.h"
#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/core/text_file.h"

namespace facespace {
namespace {

struct Options {
  std::string out, tables;
  SpacePlan plan;
  bool judge = false, quiet = false;
};

void Print(const std::vector<GivenBack>& judged) {
  fmt::print("expression      point                    rms off   worst off\n");
  for (const GivenBack& back : judged) {
    fmt::print("{:<12} {}   {:>6.3f} {:>6.3f} {:>6.3f}   {:>7.3f} {:>11.3f}\n", back.emotion,
               back.pattern, back.at[0], back.at[1], back.at[2], back.rms, back.worst);
  }
}

void Run(const Options& options) {
  const fsm::MotionTables tables = vm::OrThrow(fsm::MotionTables::Load(options.tables));
  if (options.judge) {
    Print(JudgeSpace(tables.emotion_space, tables.expressions, BuiltAxes()));
    return;
  }
  if (options.out.empty()) throw std::runtime_error("--out TABLE or --judge expected");
  fsm::EmotionSpace space;
  {
    Progress progress("learning the space", options.quiet);
    space = vm::OrThrow(LearnSpace(options.plan, tables.expressions, BuiltAxes(),
                                   [&](double done, double) { progress.At(done); }));
  }
  vm::OrThrow(vm::WriteTextFile(options.out, FormatSpace(space)));
  Print(JudgeSpace(space, tables.expressions, BuiltAxes()));
}

}  // namespace

Command AddEmotions(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App& emotions = *app.add_subcommand(
      "emotions", "Learns the emotion space: the table emotion_space.txt of fsm");
  emotions.add_option("--out", options->out, "The table to write");
  emotions.add_option("--tables", options->tables,
                      "Tables in place of fsm's own, with emotions of one's own");
  emotions.add_flag("--judge", options->judge,
                    "Learns nothing: how the tables' space gives expressions back");
  emotions.add_option("--hidden", options->plan.hidden, "Units beside the middle (48)")
      ->check(CLI::Range(3, 256));
  emotions.add_option("--steps", options->plan.steps, "Steps of 96 expressions (20000)")
      ->check(CLI::Range(1, 1'000'000));
  emotions
      .add_option("--lead", options->plan.lead, "How strongly emotions are led to their axes (1)")
      ->check(CLI::Range(0.0, 10.0));
  emotions.add_option("--seed", options->plan.seed, "Of all that happens by chance (1)");
  emotions.add_flag("--quiet", options->quiet, "No progress on standard error");
  return [options] { Run(*options); };
}

}  // namespace facespace
