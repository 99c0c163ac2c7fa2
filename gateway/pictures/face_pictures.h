#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ssm/process/child_process.h"
#include "vdm/net/mouth_frame.h"
#include "vm_protocol/runtime/private_folder.h"
#include "vm_protocol/runtime/stream_peer.h"
#include "vm_protocol/web/live_records.h"

namespace gateway {

/// Pictures of a face that says one client's sound: a face program (fsm) of our own, spoken to in
/// the protocol. Its clock is ours (Clock.mode = HUB): it is moved on to the time of each picture
/// once the mouth up to there is known, so pictures show the sound's own time however fast that
/// comes. Several sounds may follow each other; each counts its time from its own beginning.
/// Lifetime: the context outlives it; it ends its program. Thread: the context's; events come from
/// within no call. Limits: an answer has kAnswerLimit; a picture 8 MiB. Errors: `failed`, once.
class FacePictures {
 public:
  static constexpr auto kAnswerLimit = std::chrono::seconds(30);
  static constexpr double kBehindS = 1;
  struct Settings {
    unsigned width = 256, height = 256;  ///< 64 to 1024
    unsigned fps = 25;                   ///< 10, 20, 25 or 50
  };
  struct Events {
    std::function<void(std::uint32_t sound, double at_s, const std::string& jpeg)> picture;
    std::function<void()> caught_up;  ///< less than kBehindS is to be drawn
    std::function<void(const std::string& why)> failed;
  };
  /// `command` starts the face program; the size is added. Errors: kUnavailable.
  static vm::Result<std::unique_ptr<FacePictures>> Start(boost::asio::io_context& io,
                                                         std::vector<std::string> command,
                                                         const Settings& settings, Events events);
  ~FacePictures();
  FacePictures(const FacePictures&) = delete;

  /// The mouth at a moment of the sound; in order of time.
  void Add(double at_s, const vdm::MouthFrame& mouth);
  /// The sound is over; `done` is called when all of it has been drawn. What is added next belongs
  /// to the next sound.
  void End(std::function<void()> done);
  /// What was not drawn yet is void, also pictures on their way.
  void Clear();
  bool behind() const { return last_s_ - static_cast<double>(drawn_) / settings_.fps > kBehindS; }

 private:
  struct Sound {
    std::uint32_t number = 0;
    double from_ms = 0;  // on the face's clock
    bool wanted = true;
  };
  FacePictures(boost::asio::io_context& io, const Settings& settings, Events events);
  vm::Result<void> Begin(std::vector<std::string> command);
  void Ask(const std::string& line, std::function<void(const std::string& value)> next);
  void OnLine(std::string_view line);
  void MoveOn();
  void EndSound();
  void NextSound(bool wanted);
  void ReadPictures();
  void TakePictures();
  void Fail(const std::string& why);

  boost::asio::io_context& io_;
  const Settings settings_;
  const Events events_;
  vm::PrivateFolder folder_;  // of the socket
  boost::asio::local::stream_protocol::acceptor acceptor_;
  boost::asio::local::stream_protocol::socket socket_;
  std::vector<char> piece_;
  vm::LiveRecords records_{"the face", "picture MS BYTES", 8u << 20};
  std::unique_ptr<ssm::ChildProcess> process_;
  std::shared_ptr<vm::StreamPeer> stream_;
  boost::asio::steady_timer limit_;
  unsigned last_tag_ = 0;
  std::deque<std::function<void(const std::string& value)>> answers_;  // in the order asked
  std::deque<Sound> sounds_{{}};  // the last is being said, pictures of the others may come
  std::deque<std::pair<double, std::string>> mouths_;  // s of the sound, and its line
  double last_s_ = 0;                                  // up to here the mouth is known
  unsigned drawn_ = 0;                                 // pictures of this sound
  double shown_ms_ = 0;                                // of the newest picture that came
  bool ready_ = false, moving_ = false, failed_ = false;
  std::function<void()> done_;  // the sound is over
  const std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
};

/// "256x256" and "25" as a client asks for them. kBadValue says what was found and expected.
vm::Result<FacePictures::Settings> ReadPictureSettings(std::string_view size, std::string_view fps);

}  // namespace gateway
