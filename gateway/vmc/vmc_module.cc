#include "gateway/vmc/vmc_module.h"

#include <utility>

namespace gateway {
namespace {

constexpr std::size_t kMostSubjectBytes = 64;

struct NamesWord {
  const char* word;
  VmcNames names;
};
constexpr NamesWord kNames[]{
    {"VRM0", VmcNames::kVrm0}, {"VRM1", VmcNames::kVrm1}, {"PERFECTSYNC", VmcNames::kPerfectSync}};

}  // namespace

VmcModule::VmcModule(vm::Scheduler& scheduler, Options options)
    : scheduler_(scheduler), options_(std::move(options)), slots_("VMC") {
  vm::DeclareCommonSlots(slots_, {.module_version = options_.module_version,
                                  .protocol_version = "Galatea protocol 1.0",
                                  .on_exit = [this] { exit_requested_ = true; }});
  Declare();
  slots_.set_on_heard([this](const vm::Message& message) {
    // A face that begins anew has forgotten whom it told.
    if (message.command == vm::Command::kRep && message.slot == "Run" && message.value == "LIVE" &&
        message.from == face_) {
      AskFace();
    }
  });
  meet_timer_ = scheduler_.Post([this] {
    meet_timer_ = 0;
    slots_.Say(vm::To("AM", vm::Set("Subscribe", face_)));
    AskFace();
  });
}

void VmcModule::Shutdown() {
  for (vm::TimerId* timer : {&meet_timer_, &again_timer_}) {
    if (*timer != 0) scheduler_.Cancel(std::exchange(*timer, 0));
  }
}

void VmcModule::AskFace() {
  slots_.Say(vm::To(face_, vm::Set("Frame.to", sending_ ? slots_.module_name() : "NONE")));
}

void VmcModule::Declare() {
  slots_.Declare({.name = "To",
                  .grammar = "<word>",
                  .initial = options_.to,
                  .help =
                      "Where bundles go, over UDP: HOST:PORT. Programs that draw avatars listen at "
                      "39539, or 39540.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    if (auto aimed = options_.aim(value.word(0)); !aimed) {
                      return std::unexpected(aimed.error());
                    }
                    Send();
                    return value.word(0);
                  },
                  .saved = false});
  slots_.Declare(
      {.name = "Send",
       .grammar = "ON | OFF",
       .initial = "ON",
       .help =
           "OFF: the face is not followed, and nothing is sent. ON again asks the face anew, as is "
           "needed after its Run = INIT.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         sending_ = value.word(0) == "ON";
         AskFace();
         return value.word(0);
       }});
  slots_.Declare({.name = "Protocol",
                  .grammar = "VMC | LIVELINK",
                  .initial = "VMC",
                  .help = "LIVELINK: frames are told as the app Live Link Face tells them, to "
                          "Unreal, which listens at 11111; Names means nothing then.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    live_link_ = value.word(0) == "LIVELINK";
                    Send();
                    return value.word(0);
                  }});
  slots_.Declare({.name = "Subject",
                  .grammar = "<word>",
                  .initial = "Galatea",
                  .help = "The name under which Unreal shows the face (Protocol = LIVELINK), at "
                          "most 64 bytes.",
                  .on_set = [](const vm::SetValue& value) -> vm::Result<std::string> {
                    if (value.word(0).size() <= kMostSubjectBytes) return value.word(0);
                    return vm::Fail(vm::Errc::kTooLong, "found " +
                                                            std::to_string(value.word(0).size()) +
                                                            " bytes, expected at most " +
                                                            std::to_string(kMostSubjectBytes));
                  }});
  slots_.Declare(
      {.name = "Names",
       .grammar = "VRM0 | VRM1 | PERFECTSYNC",
       .initial = "VRM0",
       .help = "What the weights are called: the expressions of VRM 0.x (A, Joy, Blink_L) or "
               "of VRM 1.0 (aa, happy, blinkLeft), or the 52 of ARKit (JawOpen). Case counts "
               "with those who listen.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         for (const NamesWord& one : kNames) {
           if (value.word(0) == one.word) bundle_.names = one.names;
         }
         Send();
         return value.word(0);
       }});
  slots_.Declare({.name = "Bones",
                  .grammar = "ON | OFF",
                  .initial = "ON",
                  .help = "Whether head, neck and eyes turn, too. Their places are told as 0, so a "
                          "program that takes places of bones, not only turns, needs OFF.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    bundle_.bones = value.word(0) == "ON";
                    Send();
                    return value.word(0);
                  }});
  slots_.Declare({.name = "FaceFrame",
                  .grammar = "<text>",
                  .access = vm::Access::kWriteOnly,
                  .help = "The face at one instant, as the face's Frame.to tells it.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    auto frame = ParseFaceFrame(value.text);
                    if (!frame) return std::unexpected(frame.error());
                    last_ = *frame;
                    Send();
                    return std::string();
                  },
                  .saved = false});
  slots_.Declare({.name = "Sent",
                  .grammar = "<int>",
                  .access = vm::Access::kReadOnly,
                  .initial = "0",
                  .help = "How many bundles or packets the system took to send; whether they "
                          "arrived UDP does not tell.",
                  .on_inq = [this] { return std::to_string(sent_); }});
}

void VmcModule::Send() {
  if (!last_ || !sending_) return;
  const FaceWeights& weights = FaceWeights::Built();
  const bool sent = options_.send(live_link_ ? LiveLinkPacket(*last_, weights,
                                                              {.id = options_.id,
                                                               .subject = slots_.Value("Subject"),
                                                               .angles = bundle_.bones})
                                             : VmcBundle(*last_, weights, bundle_));
  if (sent) ++sent_;
  if (again_timer_ != 0) scheduler_.Cancel(std::exchange(again_timer_, 0));
  if (!options_.real()) return;
  again_timer_ = scheduler_.After(kAgain, [this] {
    again_timer_ = 0;
    Send();
  });
}

}  // namespace gateway
