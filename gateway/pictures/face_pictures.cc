#include "gateway/pictures/face_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <charconv>
#include <utility>

#include "vm_protocol/core/client.h"
#include "vm_protocol/core/message.h"
#include "vm_protocol/core/utf8.h"

namespace gateway {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

constexpr std::size_t kReadBytes = 64u << 10;
constexpr std::chrono::milliseconds kLastPictureLimit{200};  // after the sound was drawn

std::string MouthLine(double at_s, const vdm::MouthFrame& frame) {
  std::string line = fmt::format("set MouthFrame = {:g}", at_s * 1000);
  for (const float number : frame.mouth) line += fmt::format(" {:.4g}", number);
  return line + fmt::format(" {:.3g} {:.3g}", std::clamp(frame.seal, 0.0F, 1.0F),
                            std::clamp(frame.tongue, 0.0F, 1.0F));
}

}  // namespace

vm::Result<std::unique_ptr<FacePictures>> FacePictures::Start(asio::io_context& io,
                                                              std::vector<std::string> command,
                                                              const Settings& settings,
                                                              Events events) {
  std::unique_ptr<FacePictures> face(new FacePictures(io, settings, std::move(events)));
  if (auto begun = face->Begin(std::move(command)); !begun) return std::unexpected(begun.error());
  return face;
}

FacePictures::FacePictures(asio::io_context& io, const Settings& settings, Events events)
    : io_(io),
      settings_(settings),
      events_(std::move(events)),
      acceptor_(io),
      socket_(io),
      piece_(kReadBytes),
      limit_(io) {}

FacePictures::~FacePictures() {
  *alive_ = false;
  if (stream_) stream_->Close();
}

vm::Result<void> FacePictures::Begin(std::vector<std::string> command) {
  const auto no_socket = [](const std::string& why) {
    return vm::Fail(vm::Errc::kUnavailable, "no socket for pictures: " + why);
  };
  if (!folder_.Make("pictures", "socket")) return no_socket("no folder for it");
  error_code error;
  acceptor_.open(asio::local::stream_protocol(), error);
  if (!error) acceptor_.bind(folder_.file(), error);
  if (!error) acceptor_.listen(1, error);
  if (error) return no_socket(error.message());
  acceptor_.async_accept(socket_, [this, alive = alive_](const error_code& failed) {
    if (*alive && !failed) ReadPictures();
  });
  command.insert(command.end(),
                 {"--size", fmt::format("{}x{}", settings_.width, settings_.height)});
  auto process = ssm::ChildProcess::Start(command, false);
  if (!process) return std::unexpected(process.error());
  process_ = std::move(*process);
  const auto [output, input] = process_->TakeDescriptors();
  stream_ = vm::StreamPeer::Make(io_, output, input, vm::Framing::kLf);
  stream_->Start(
      [this, alive = alive_](vm::Result<std::string_view> line) {
        if (*alive && line) OnLine(*line);
      },
      [this, alive = alive_](const vm::StreamEnd& end) {
        if (*alive) Fail("it has ended: " + end.reason);
      });
  stream_->ResumeReading();
  for (const std::string& line : {std::string("set#{} Clock.mode = HUB"),
                                  fmt::format("set#{{}} Picture.fps = {}", settings_.fps),
                                  "set#{} Picture.to = unix:" + folder_.file()}) {
    Ask(line, [](const std::string&) {});
  }
  Ask("inq#{} Clock", [this](const std::string& now) {
    std::from_chars(now.data(), now.data() + now.size(), sounds_.back().from_ms);
    stream_->Send(fmt::format("set MouthFrame.start = @{:g}", sounds_.back().from_ms));
    ready_ = true;
    MoveOn();
  });
  return {};
}

/// {} stands for the tag.
void FacePictures::Ask(const std::string& line, std::function<void(const std::string&)> next) {
  std::string tagged = line;
  tagged.replace(tagged.find("{}"), 2, std::to_string(++last_tag_));
  answers_.push_back(std::move(next));
  if (answers_.size() == 1) {
    limit_.expires_after(kAnswerLimit);
    limit_.async_wait([this, alive = alive_](const error_code& stopped) {
      if (*alive && !stopped) Fail("it does not answer");
    });
  }
  stream_->Send(tagged);
}

void FacePictures::OnLine(std::string_view line) {
  const auto message = vm::ParseMessage(line);
  if (!message || message->tag.empty() || answers_.empty() || failed_) return;
  if (message->slot.ends_with(".error") || message->slot == "Error") return Fail(message->value);
  const auto next = std::move(answers_.front());
  answers_.pop_front();
  limit_.cancel();
  next(message->value);
}

void FacePictures::Add(double at_s, const vdm::MouthFrame& mouth) {
  if (failed_) return;
  mouths_.emplace_back(at_s, MouthLine(at_s, mouth));
  last_s_ = at_s;
  MoveOn();
}

/// To the next picture, if the mouth is known up to there.
void FacePictures::MoveOn() {
  if (!ready_ || moving_ || failed_) return;
  const double next_s = static_cast<double>(drawn_ + 1) / settings_.fps;
  if (next_s > last_s_ + 1e-6) {
    if (!done_) return;
    // What was drawn is on its way, but for pictures that look like the one before.
    if (shown_ms_ + 1 > sounds_.back().from_ms + 1000.0 * drawn_ / settings_.fps) return EndSound();
    limit_.expires_after(kLastPictureLimit);
    return limit_.async_wait([this, alive = alive_](const error_code& stopped) {
      if (*alive && !stopped && done_) EndSound();
    });
  }
  // One behind the picture as well: between two the face moves.
  while (!mouths_.empty()) {
    const bool beyond = mouths_.front().first > next_s;
    stream_->Send(mouths_.front().second);
    mouths_.pop_front();
    if (beyond) break;
  }
  moving_ = true;
  Ask(fmt::format("set#{{}} Clock = {:g}", sounds_.back().from_ms + next_s * 1000),
      [this, number = sounds_.back().number](const std::string&) {
        const bool was_behind = behind();
        moving_ = false;
        if (number == sounds_.back().number) ++drawn_;
        MoveOn();
        if (was_behind && !behind()) events_.caught_up();
      });
}

/// Whoever waits for the end hears of it by the loop.
void FacePictures::EndSound() {
  limit_.cancel();
  NextSound(true);
  asio::post(io_, std::exchange(done_, nullptr));
}

/// Begins where the clock stands, or will when it has moved.
void FacePictures::NextSound(bool wanted) {
  Sound next = sounds_.back();
  sounds_.back().wanted = wanted;
  ++next.number;
  next.from_ms += 1000.0 * (drawn_ + (moving_ ? 1 : 0)) / settings_.fps;
  sounds_.push_back(next);
  if (sounds_.size() > 8) sounds_.pop_front();
  mouths_.clear();
  last_s_ = 0;
  drawn_ = 0;
  if (!ready_) return;  // it is told once it is
  if (!wanted) stream_->Send("set MouthFrame.start = STOP");
  stream_->Send(fmt::format("set MouthFrame.start = @{:g}", next.from_ms));
}

void FacePictures::End(std::function<void()> done) {
  if (failed_) return asio::post(io_, std::move(done));
  done_ = std::move(done);
  MoveOn();
}

void FacePictures::Clear() {
  done_ = nullptr;
  NextSound(false);
}

void FacePictures::ReadPictures() {
  socket_.async_read_some(asio::buffer(piece_),
                          [this, alive = alive_](const error_code& error, std::size_t size) {
                            if (!*alive || failed_) return;
                            if (error) return Fail("it sends no more pictures");
                            records_.Add({piece_.data(), size});
                            TakePictures();
                            if (*alive && !failed_) ReadPictures();
                          });
}

void FacePictures::TakePictures() {
  const auto alive = alive_;  // who is shown a picture may end this
  while (*alive) {
    const auto piece = records_.Next();
    if (!piece) return Fail(piece.error().text);
    if (!*piece) return done_ ? MoveOn() : void();
    const double at_ms = static_cast<double>((*piece)->at.count()) / 1000;
    shown_ms_ = at_ms;
    // The last that had begun before. The first picture shows the face before any sound.
    const auto sound = std::ranges::find_if(sounds_.rbegin(), sounds_.rend(),
                                            [&](const Sound& one) { return at_ms > one.from_ms; });
    if (sound == sounds_.rend() || !sound->wanted) continue;
    events_.picture(sound->number, (at_ms - sound->from_ms) / 1000, (*piece)->bytes);
  }
}

void FacePictures::Fail(const std::string& why) {
  if (std::exchange(failed_, true)) return;
  limit_.cancel();
  last_s_ = 0;  // nothing is behind
  asio::post(io_, [alive = alive_, failed = events_.failed, why = "the face: " + why,
                   done = std::exchange(done_, nullptr)] {
    if (*alive) failed(why);
    if (*alive && done) done();  // what waits for the end of a sound waits no longer
  });
  if (done_) asio::post(io_, std::exchange(done_, nullptr));
}

vm::Result<FacePictures::Settings> ReadPictureSettings(std::string_view size,
                                                       std::string_view fps) {
  const auto wrong = [](const char* name, std::string_view found, const char* expected) {
    return vm::Fail(vm::Errc::kBadValue, std::string(name) + ": found '" +
                                             vm::ShownUtf8(vm::CutUtf8(found, 40)) +
                                             "', expected " + expected);
  };
  FacePictures::Settings settings;
  const auto number = [](std::string_view text, unsigned& to) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), to);
    return error == std::errc() && end == text.data() + text.size();
  };
  const std::size_t by = std::min(size.find('x'), size.size());
  const bool read = number(size.substr(0, by), settings.width) &&
                    number(size.substr(std::min(by + 1, size.size())), settings.height);
  const auto fits = [](unsigned side) { return side >= 64 && side <= 1024; };
  if (!read || !fits(settings.width) || !fits(settings.height))
    return wrong("pictures", size, "WIDTHxHEIGHT, each from 64 to 1024");
  if (!number(fps, settings.fps) ||
      (settings.fps != 10 && settings.fps != 20 && settings.fps != 25 && settings.fps != 50))
    return wrong("picture_fps", fps, "one of 10, 20, 25, 50");
  return settings;
}

}  // namespace gateway
