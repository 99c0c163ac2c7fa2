#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fsm/app/fsm_module.h"
#include "fsm/film/film_writer.h"
#include "vm_protocol/core/scheduler.h"

namespace fsm {

/// View, faces and files in memory: pictures are one pixel that says how far the jaw is open.
class FakeWorld final : public FaceView, public FaceLibrary, private ViewWindow {
 public:
  struct FakeFilm {
    std::vector<float> jaws;
    std::string sound;
    bool finished = false;
  };

  vm::Result<void> Draw(const FaceState& state, const Scene& scene,
                        const StateHistory* history) override {
    if (!no_drawing.empty()) return vm::Fail(vm::Errc::kUnavailable, no_drawing);
    ++draws;
    last_state = state;
    last_scene = scene;
    simulated = history != nullptr;
    image_.width = image_.height = 1;
    image_.rgba = {static_cast<std::uint8_t>(std::lround(state.mouth[kJawY] * 10)), 0, 0, 255};
    return {};
  }
  const Image& Read() override { return image_; }
  std::uint64_t BeginRead() override {
    readings.push_back(image_);
    return readings.size() - 1;
  }
  vm::Result<void> EndRead(std::uint64_t frame, Image& out) override {
    out = std::exchange(readings.at(frame), {});
    return {};
  }
  void DropRead(std::uint64_t frame) override { readings.at(frame) = {}; }
  vm::Result<MouthMeasure> Measure(const FaceState& state) override {
    if (!no_head.empty()) return vm::Fail(vm::Errc::kUnavailable, no_head);
    return MouthMeasure{state.mouth[kUpperInnerY] - state.mouth[kLowerInnerY],
                        50 + 2 * state.mouth[kCornerX], state.mouth[kJawY]};
  }
  std::vector<std::string> Faces() const override { return {"galatea", "pygmalion"}; }
  vm::Result<void> Select(const std::string& name) override {
    if (name != "galatea" && name != "pygmalion") {
      return vm::Fail(vm::Errc::kBadValue,
                      "there is no face '" + name + "'; galatea pygmalion expected");
    }
    if (name == gone) return vm::Fail(vm::Errc::kUnavailable, name + " cannot be made");
    face = name;
    return {};
  }
  int width() const override { return width_; }
  int height() const override { return height_; }
  vm::Result<void> Resize(int width, int height) override {
    width_ = width;
    height_ = height;
    return {};
  }
  bool Swings() const override { return swings; }
  ViewWindow* window() override { return has_window ? this : nullptr; }

  MediaFiles files{
      .write_image = [this](const Image&, const std::string& path) -> vm::Result<void> {
        if (!path.ends_with(".png") && !path.ends_with(".bmp") && !path.ends_with(".rgb")) {
          return vm::Fail(vm::Errc::kBadValue, path + " ends in none of .png .bmp .rgb");
        }
        pictures[path] = last_state;
        return {};
      },
      .read_image = [](const std::string& path) -> vm::Result<Image> {
        if (path == "missing.png") return vm::Fail(vm::Errc::kUnavailable, "cannot read " + path);
        return Image{1, 1, {1, 2, 3, 255}};
      },
      .open_film = [this](const std::string& path, int, int, double,
                          const std::string&) -> vm::Result<std::unique_ptr<FilmWriter>> {
        if (!path.ends_with(".mp4")) return vm::Fail(vm::Errc::kBadValue, path + " is not .mp4");
        return std::make_unique<FakeFilmWriter>(films[path]);
      }};
  std::map<std::string, FaceState> pictures;
  std::map<std::string, FakeFilm> films;
  FaceState last_state;
  Scene last_scene;
  std::string face;
  std::string gone;             ///< the face that cannot be made
  std::vector<Image> readings;  ///< of BeginRead, emptied by EndRead and DropRead
  int draws = 0;
  int shown = 0;
  bool has_window = false;
  bool simulated = false;  ///< the picture drawn last
  bool swings = false;
  bool fills_screen = false;
  bool closed = false;
  std::string no_head;     ///< the reason why no head can be made, "" = it can
  std::string no_drawing;  ///< the reason why nothing can be drawn, "" = all can

 private:
  class FakeFilmWriter final : public FilmWriter {
   public:
    explicit FakeFilmWriter(FakeFilm& film) : film_(film) {}
    vm::Result<void> Add(const Image& frame) override {
      film_.jaws.push_back(static_cast<float>(frame.rgba[0]) / 10);
      return {};
    }
    vm::Result<void> Finish(const std::string& sound) override {
      film_.sound = sound;
      film_.finished = true;
      return {};
    }

   private:
    FakeFilm& film_;
  };

  void FillScreen(bool fill) override { fills_screen = fill; }
  void Show() override { ++shown; }
  bool close_requested() const override { return closed; }

  Image image_;
  int width_ = 640;
  int height_ = 480;
};

/// The module on a virtual clock, and what it said.
struct FsmStage {
  explicit FsmStage(FsmOptions options = {}, bool window = false)
      : module((world.has_window = window, clock), world, world, world.files, std::move(options)) {
    module.slots().set_output([this](vm::PeerId, const vm::Message& message) {
      said.push_back(vm::FormatMessage(message));
    });
    module.slots().set_on_error([this](vm::PeerId, const std::string&, const vm::Error& error) {
      errors.push_back(vm::FormatError(error));
    });
  }
  /// Says a line and gives what the module answered to it at once, joined by '|'.
  std::string Say(const std::string& line) {
    Take();
    module.slots().HandleLine(line, 1);
    return Take();
  }
  /// Lets time pass until `ms`; gives what was said meanwhile.
  std::string Until(double ms) {
    Take();
    clock.RunUntil(FromMs(ms));
    return Take();
  }
  std::string Take() {
    std::string all;
    for (const std::string& line : said) all += (all.empty() ? "" : "|") + line;
    said.clear();
    return all;
  }
  FaceState Now() { return module.motion().StateAt(clock.Now()); }

  vm::VirtualScheduler clock;
  FakeWorld world;
  FsmModule module;
  std::vector<std::string> said;
  std::vector<std::string> errors;
};

}  // namespace fsm
