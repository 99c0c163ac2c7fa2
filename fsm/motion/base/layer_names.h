#pragma once

#include <string_view>

namespace fsm {

/// The layers of the built-in sources; tables/mixing.txt says what they are and how they are
/// weighted. Sources from outside may have others.
struct LayerName {
  static constexpr std::string_view kBlendShapes = "blend_shapes", kEmotions = "emotions",
                                    kExpression = "expression", kEyes = "eyes",
                                    kGestures = "gestures", kHead = "head", kIdle = "idle",
                                    kIdleFace = "idle_face", kMood = "mood", kMouth = "mouth",
                                    kMouthStream = "mouth_stream", kNods = "nods",
                                    kStreamGestures = "stream_gestures", kSpeech = "speech",
                                    kText = "text", kUnits = "units";
};

/// The signals of the built-in sources, as above.
struct SignalName {
  static constexpr std::string_view kSpeaking = "speaking", kLipsTaken = "lips_taken",
                                    kStreamTaken = "stream_taken", kHeadTaken = "head_taken",
                                    kContact = "contact", kExpression = "expression",
                                    kAtUser = "at_user";
};

}  // namespace fsm
