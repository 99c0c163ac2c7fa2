#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "fsm/motion/inputs/motion_tables.h"
#include "vdm/prosody/head_net.h"
#include "vdm/train/corpus.h"
#include "vdm/train/dice.h"

namespace vdm {

/// What a head does with some speech, each 10 ms: columns are instants.
struct HeadLesson {
  std::string who;
  Eigen::MatrixXf inputs;             ///< of HeadNet
  Eigen::MatrixXf truth;              ///< of HeadNet: degrees, and the brow
  std::vector<std::uint64_t> phrase;  ///< which one it is in; 0: none, the head rests or goes home
};

/// Where the head is at an instant of the sound, in ms.
using HeadTruth = std::function<HeadPose(double ms)>;

/// The lesson of a sound, with inputs as a running vdm has them. `emotion`: the factor, 0 .. 1;
/// `sounds`: HeadNet::sounds, 0 or as many as the shipped mouth has;
/// `late_ms`: by so much the head shall be late beside the truth.
HeadLesson MakeHeadLesson(std::string who, const std::vector<std::int16_t>& samples, float emotion,
                          std::size_t sounds, double late_ms, const HeadTruth& truth);

/// One voice's sentences, one after the other, with pauses of 150 to 1500 ms.
struct Talk {
  std::string voice;
  std::vector<std::int16_t> samples;
  vm::PhonemeList phonemes;
};
/// `sentences` takes in each, in order; the rest of a voice is left.
std::vector<Talk> TalksOf(const std::vector<Take>& takes, std::size_t sentences, Dice dice);

/// What the face itself does with head and brows when a text is spoken (Autonomous SPEECH): pattern
/// 1 with an emotion of 0, pattern 2 with 1, between them in between. `tables` outlives it.
HeadTruth TextDrivenHead(const Talk& talk, float emotion, const fsm::MotionTables& tables,
                         std::uint64_t seed);

/// Recordings of people: a list, each line `WAV CSV [EMOTION]`, paths without blanks, beside the
/// list where they are relative. The CSV: a line of names, ms, down, right, tilt and brow in any
/// order among others, then a line an instant, times rising, instants at most 200 ms apart where it
/// shall be learned from: degrees down, to the viewer's right and tilt to it, and the strength of
/// AU 1 and 2. Or what face_track prints of a film: its angles less their medians, the brow the
/// mean of its units 1 and 2; pictures without a face are left out. Errors: kUnavailable, kBadValue
/// with file and line.
vm::Result<std::vector<HeadLesson>> ReadHeadLessons(const std::string& list, std::size_t sounds,
                                                    double late_ms);

}  // namespace vdm
