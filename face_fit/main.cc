// Makes a face that fsm can wear from a photo of a person.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <exception>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "face_fit/find/face/hand_points.h"
#include "face_fit/find/head/head_finder.h"
#include "face_fit/find/network/face_networks.h"
#include "face_fit/image/filters.h"
#include "face_fit/image/photo.h"
#include "face_fit/make_face.h"
#include "fsm/faces/face_folder.h"
#include "fsm/faces/face_of_name.h"
#include "fsm/faces/original_config.h"
#include "fsm/image/image_file.h"
#include "fsm/mesh/original/pnt_file.h"
#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/core/text_file.h"

namespace {

/// Prints each step and the time since the start to stderr.
class Progress {
 public:
  explicit Progress(bool quiet) : quiet_(quiet) {}
  void operator()(const char* what) const {
    const std::chrono::duration<double> since = Clock::now() - start_;
    if (!quiet_) std::fprintf(stderr, "face_fit: %5.2f s  %s\n", since.count(), what);
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  Clock::time_point start_ = Clock::now();
};

struct Options {
  std::vector<std::string> side_photos;
  std::string photo, name, out, base = "galatea", networks, head, points, galatea, tables;
  std::optional<bool> glasses;  // nothing: to be detected
  int face = 1;
  bool quiet = false;
};

/// Finds eyes, nose and mouth of a head from elsewhere and writes them to a file beside it.
void WritePointsOfHead(const Options& options) {
  const Progress progress(options.quiet);
  const fsm::ImportedHead file = vm::OrThrow(fsm::ReadImportedHead(options.head));
  facefit::FaceNetworks networks = vm::OrThrow(facefit::FaceNetworks::Load(options.networks));
  progress("head and networks read");
  const auto points =
      vm::OrThrow(facefit::FindHeadPoints(networks, file, options.head, options.base));
  progress("points found");
  const std::string path = options.out.empty() ? options.head + ".points" : options.out;
  vm::OrThrow(vm::WriteTextFile(path, fsm::FormatHeadPoints(points)));
  std::cout << "face_fit: wrote " << path << "\n";
}

void Notice(const std::string& what) { std::cerr << "face_fit: notice: " << what << "\n"; }
void NoticeRejected(const std::string& path, const std::string& reason) {
  Notice("'" + path + "' is left out: " + reason);
}

/// Reads the photos from the side; prints a notice for each that cannot be read.
std::vector<facefit::SidePhoto> ReadSidePhotos(const Options& options,
                                               facefit::FaceNetworks& networks) {
  std::vector<facefit::SidePhoto> side_photos;
  for (const std::string& path : options.side_photos) {
    if (auto side_photo = facefit::ReadSidePhoto(networks, path)) {
      side_photos.push_back(std::move(*side_photo));
    } else {
      NoticeRejected(path, side_photo.error().text);
    }
  }
  return side_photos;
}

/// Throws std::runtime_error with what is missing.
void CheckOptions(const Options& options) {
  if (!fsm::IsFaceName(options.name)) {
    throw std::runtime_error("--name '" + options.name +
                             "': letters, digits, - and _ expected, as anna");
  }
  vm::OrThrow(facefit::CheckSidePhotoCount(options.side_photos.size()));
}

/// The networks, and the head as they see it.
struct FaceModels {
  facefit::FaceNetworks networks;
  facefit::ObservedHead base;
};

std::string FolderOfFaces(const Options& options) {
  return options.out.empty() ? fsm::FacesFolder() : options.out;
}

FaceModels LoadFaceModels(const Options& options, const Progress& progress) {
  auto networks = vm::OrThrow(facefit::FaceNetworks::Load(options.networks));
  auto base = vm::OrThrow(facefit::ObservedHead::BuiltIn(networks, options.base));
  const fsm::TableFolder own =
      fsm::UnitsFolder(FolderOfFaces(options) + "/" + options.name, options.tables);
  if (const auto units = fsm::UnitsIn(own)) base.UseUnits(*units);
  progress("networks read, head looked at");
  return {std::move(networks), std::move(base)};
}

/// Makes a face from a photo and writes it.
void MakeAndWriteFace(const Options& options, FaceModels& models, const facefit::FrontPhoto& front,
                      const facefit::FrontFace& face, const Progress& progress) {
  const std::vector<facefit::SidePhoto> read = ReadSidePhotos(options, models.networks);
  std::vector<const facefit::SidePhoto*> side_photos;
  for (const facefit::SidePhoto& side_photo : read) side_photos.push_back(&side_photo);
  const auto made = vm::OrThrow(facefit::MakeFace(
      models.base, front, face, facefit::SidePhotoSet{models.networks, side_photos},
      options.glasses, progress));
  for (const auto& [path, reason] : made.rejected) NoticeRejected(path, reason);
  const std::string folder = vm::OrThrow(
      fsm::WriteFace(made.baked.head, made.report, FolderOfFaces(options), options.name));
  progress("written");
  std::cout << made.report << "face_fit: wrote " << folder << "\n";
}

/// Returns the face; throws std::runtime_error if none was found, or only an uncertain one.
const facefit::FrontFace& RequireFace(const Options& options, const facefit::PreparedFront& front) {
  const char* by_hand = "; --points FILE with a few points set by hand helps (docs/photo.md)";
  if (!front.face) {
    throw std::runtime_error(
        "no face found in '" + options.photo +
        "': it should look into the camera, be lit and fill a tenth of the picture or more" +
        by_hand);
  }
  if (front.face->found.certainty < facefit::kCertainFace) {
    throw std::runtime_error("what looked like a face in '" + options.photo +
                             "' has no eyes, nose and mouth that can be told apart" + by_hand);
  }
  return *front.face;
}

void MakeFaceOfPhoto(const Options& options) {
  const Progress progress(options.quiet);
  fsm::Image photo = vm::OrThrow(facefit::ReadPhoto(options.photo, facefit::kFineSize));
  facefit::FaceChoice choice = facefit::FaceNumber{options.face};
  if (!options.points.empty()) {
    const std::string text = vm::OrThrow(vm::ReadTextFile(options.points, 1U << 20));
    choice = vm::OrThrow(facefit::ParseHandPoints(options.points, text));
  }
  progress("photo read");
  FaceModels models = LoadFaceModels(options, progress);
  const auto front = facefit::PrepareFront(models.networks, models.base, std::move(photo), choice,
                                           facefit::PhotoExtent::kCloseUp, progress);
  if (!front) {
    const std::string& of = options.points.empty() ? options.photo : options.points;
    throw std::runtime_error(of + ": " + front.error().text);
  }
  if (front->photo.orientation != 1) {
    Notice("the photo lies on its side or head, whatever its file says; it was set upright");
  }
  MakeAndWriteFace(options, models, front->photo, RequireFace(options, *front), progress);
}

/// Returns the files of the face in the original's configuration; throws std::runtime_error if it
/// has no such face.
fsm::OriginalFaceFiles FilesOfOriginal(const Options& options) {
  const auto config = vm::OrThrow(fsm::OriginalConfig::Read(options.galatea));
  std::string names;
  for (const auto& face : config.faces) {
    if (face.name == options.name) return face;
    names += " " + face.name;
  }
  throw std::runtime_error(options.galatea + " has no face '" + options.name + "'; it has" +
                           (names.empty() ? " none" : ":" + names));
}

void MakeFaceOfOriginal(const Options& options) {
  const Progress progress(options.quiet);
  const auto files = FilesOfOriginal(options);
  // Points refer to a photo of at most that size.
  fsm::Image photo =
      facefit::ScaledToFit(vm::OrThrow(fsm::ReadImage(files.picture)), facefit::kWorkingSize);
  const auto points = vm::OrThrow(facefit::PointsOfWireframe(
      files.wireframe, vm::OrThrow(fsm::ReadPnt(files.wireframe)), photo.width, photo.height));
  progress("photo read");
  FaceModels models = LoadFaceModels(options, progress);
  const auto front =
      vm::OrThrow(facefit::PrepareFront(models.networks, models.base, std::move(photo), points,
                                        facefit::PhotoExtent::kWhole, progress));
  MakeAndWriteFace(options, models, front.photo, front.face.value(), progress);
}

void Run(const Options& options) {
  if (!options.head.empty()) return WritePointsOfHead(options);
  CheckOptions(options);
  if (!options.galatea.empty()) return MakeFaceOfOriginal(options);
  MakeFaceOfPhoto(options);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Makes a face from a photo: fsm --mask NAME wears it");
  app.set_version_flag("--version", "face_fit (Galatea) " GALATEA_VERSION);
  auto* name = app.add_option("--name", options.name, "What the face is called");
  auto* source = app.add_option_group("What it is made from");
  source->require_option(1);
  source->add_option("photo", options.photo, "The photo, JPEG or PNG")->needs(name);
  auto* galatea =
      source
          ->add_option(
              "--galatea", options.galatea,
              "Instead of a photo: a configuration of the original, whose face NAME is made ours")
          ->needs(name);
  auto* head = source->add_option(
      "--head", options.head,
      "Instead: finds eyes, nose and mouth of a head (.obj, .glb, .gltf, .vrm) and writes "
      "HEAD.points, which fsm --head reads (--out: another file)");
  app.add_option("--out", options.out,
                 "Where its folder is made (default: $GALATEA_FACES or the user's data folder)");
  auto* face = app.add_option("--face", options.face, "Which of several faces, 1 = the largest");
  auto* view = app.add_option("--view,--profile", options.side_photos,
                              "Another photo of the same person turned by 20 to 60 degrees, or in "
                              "full profile; may be repeated")
                   ->expected(1)
                   ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  auto* points =
      app.add_option("--points", options.points,
                     "Points set by hand, lines NAME X Y in pixels, where no face is found");
  app.add_option("--base", options.base, "The built-in face that is warped (default galatea)");
  auto* tables = app.add_option(
      "--tables", options.tables,
      "A folder of tables: its action_units.txt says what the photo's expression does to "
      "the face, as fsm --tables");
  app.add_option("--networks", options.networks,
                 "Where the networks are (default: where scripts/face_networks.sh puts them)");
  auto* glasses = app.add_option("--glasses", options.glasses,
                                 "Whether the person wears glasses, yes or no (default: what a "
                                 "look at the nose says)")
                      ->type_name("")
                      ->check(CLI::IsMember({"yes", "no"}));
  // Options that do not apply to a way of use are refused, not ignored.
  for (CLI::Option* other : {name, face, view, points, tables, glasses}) head->excludes(other);
  for (CLI::Option* other : {face, points}) galatea->excludes(other);
  face->excludes(points);
  app.add_flag("--quiet", options.quiet, "Does not tell what is being done");
  CLI11_PARSE(app, argc, argv);
  try {
    Run(options);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "face_fit: " << error.what() << "\n";
    return 1;
  }
}
