// Our cepstra are those of sphinxbase with the settings of its en-us model.

#include "vdm/features/speech_cepstra.h"

#include <gtest/gtest.h>
#include <sphinxbase/cmd_ln.h>
#include <sphinxbase/err.h>
#include <sphinxbase/fe.h>

#include <cmath>

namespace vdm {
namespace {

TEST(SpeechCepstraTest, TheyAreThoseOfSphinxbase) {
  std::vector<std::int16_t> sound(410 + 160 * 20);
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < sound.size(); ++i) {
    state = state * 1664525U + 1013904223U;
    const double noise = static_cast<double>(state >> 16) / 65536 - 0.5;
    sound[i] = static_cast<std::int16_t>(
        3000 * std::sin(0.01 * static_cast<double>(i) * (1 + 0.001 * static_cast<double>(i))) +
        8000 * noise);
  }
  static const arg_t settings[] = {waveform_to_cepstral_command_line_macro(),
                                   {nullptr, 0, nullptr, nullptr}};
  err_set_logfp(nullptr);
  cmd_ln_t* config =
      cmd_ln_init(nullptr, settings, TRUE, "-lowerf", "130", "-upperf", "6800", "-nfilt", "25",
                  "-transform", "dct", "-lifter", "22", "-remove_noise", "no", "-remove_silence",
                  "no", "-remove_dc", "yes", nullptr);
  fe_t* front_end = fe_init_auto_r(config);
  ASSERT_NE(front_end, nullptr);
  mfcc_t** frames = nullptr;
  int32 count = 0;
  fe_start_utt(front_end);
  ASSERT_GE(fe_process_utt(front_end, sound.data(), sound.size(), &frames, &count), 0);
  ASSERT_GE(count, 20);
  const SpeechCepstra cepstra;
  for (int frame = 0; frame < 20; ++frame) {
    const auto first = static_cast<std::size_t>(frame) * 160;
    const float before = first == 0 ? 0 : sound[first - 1];
    const auto ours = cepstra.Of(before, std::span(sound).subspan(first, SpeechCepstra::kWindow));
    for (std::size_t i = 0; i < ours.size(); ++i) {
      EXPECT_NEAR(ours[i], frames[frame][i], 0.1) << "frame " << frame << ", number " << i;
    }
  }
  fe_free_2d(frames);
  fe_free(front_end);
  cmd_ln_free_r(config);
}

}  // namespace
}  // namespace vdm
