#pragma once

#include <string_view>

namespace fsm::step {

// Numbers of the steps of a rig, the same on the processor and on a graphics card (gpu_rig.cc tells
// the shaders). Millimetres where nothing else is said.

inline constexpr float kLidRadius = 13.35f;    // turns millimetres at a lid's edge into an angle
inline constexpr float kLidThickness = 0.35f;  // of a lid over the cornea
inline constexpr float kMostOpen = 0.5f;       // of a jaw that follows the chin, radians
/// How much of a push by the teeth counts, by the height over their edge: none, all.
inline constexpr float kPastTeeth = -2.2f, kBesideTeeth = 0.2f;
/// How far a row of teeth curves back, by the square and the fourth power of the place along it.
inline constexpr float kArchSquare = 0.45f, kArchFourth = 0.55f;

inline constexpr float kTongueRaise = 13;     // of the tip
inline constexpr float kTongueOffJaw = 0.8f;  // a raised tip stays when the jaw drops
inline constexpr float kTongueNoRoom = 2.5f, kTongueRoom = 5.5f;  // between teeth and lips
inline constexpr float kTongueSkin = 0.6f;     // kept between the tongue and what it touches
inline constexpr float kTongueEdges = 0.9f;    // teeth are not all of one height
inline constexpr float kBehindTeeth = 3.5f;    // of the arch, which is their outer face
inline constexpr float kTongueOut = 1.5f;      // put out this far it goes over the teeth
inline constexpr float kTongueWidest = 17;     // half its width at rest
inline constexpr float kTongueInArch = 11;     // and what goes through between the canines
inline constexpr float kTongueInLips = 0.35f;  // of the width between the lips, half the tongue's
/// It is made narrow enough for the lips this far behind the front teeth: not at all, wholly.
inline constexpr float kTongueWide = 16, kTongueNarrow = 5;
/// Teeth and lips hold it this far before and behind them: not at all, wholly.
inline constexpr float kTongueFree = 15, kTongueHeld = 9;

struct Named {
  std::string_view name;
  float value;
};
inline constexpr Named kAll[] = {{"kLidRadius", kLidRadius},       {"kLidThickness", kLidThickness},
                                 {"kMostOpen", kMostOpen},         {"kPastTeeth", kPastTeeth},
                                 {"kBesideTeeth", kBesideTeeth},   {"kTongueRaise", kTongueRaise},
                                 {"kTongueOffJaw", kTongueOffJaw}, {"kTongueNoRoom", kTongueNoRoom},
                                 {"kTongueRoom", kTongueRoom},     {"kTongueSkin", kTongueSkin},
                                 {"kTongueEdges", kTongueEdges},   {"kBehindTeeth", kBehindTeeth},
                                 {"kTongueOut", kTongueOut},       {"kTongueWidest", kTongueWidest},
                                 {"kTongueInArch", kTongueInArch}, {"kArchSquare", kArchSquare},
                                 {"kArchFourth", kArchFourth},     {"kTongueInLips", kTongueInLips},
                                 {"kTongueWide", kTongueWide},     {"kTongueNarrow", kTongueNarrow},
                                 {"kTongueFree", kTongueFree},     {"kTongueHeld", kTongueHeld}};

}  // namespace fsm::step
