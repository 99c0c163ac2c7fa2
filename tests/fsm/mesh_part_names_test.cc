// What parts of heads from elsewhere are, by the names that programs and sites give them.

#include <gtest/gtest.h>

#include <utility>

#include "fsm/mesh/part_names.h"

namespace fsm {
namespace {

using enum PartKind;

TEST(PartNamesTest, PartsOfKnownExportersAreTold) {
  // Names of node, mesh and material, as GltfReader puts them together.
  const std::pair<const char*, PartKind> parts[] = {
      // Ready Player Me
      {"Wolf3D_Head Wolf3D_Head Wolf3D_Skin", kSkin},
      {"EyeLeft EyeLeft Wolf3D_Eye", kEye},
      {"Wolf3D_Teeth Wolf3D_Teeth Wolf3D_Teeth", kTeeth},
      {"Wolf3D_Hair Wolf3D_Hair Wolf3D_Hair", kHair},
      {"Wolf3D_Glasses Wolf3D_Glasses Wolf3D_Glasses", kOther},
      {"Wolf3D_Outfit_Top Wolf3D_Outfit_Top Wolf3D_Outfit_Top", kOther},
      {"Wolf3D_Beard Wolf3D_Beard Wolf3D_Beard", kSkin},  // it follows the jaw
      // VRoid Studio
      {"Face Face.baked N00_000_00_Face_00_SKIN (Instance)", kSkin},
      {"Face Face.baked N00_000_00_FaceMouth_00_FACE (Instance)", kMouth},
      {"Face Face.baked N00_000_00_EyeIris_00_EYE (Instance)", kEye},
      {"Face Face.baked N00_000_00_EyeHighlight_00_EYE (Instance)", kEye},
      {"Face Face.baked N00_000_00_FaceBrow_00_FACE (Instance)", kSkin},
      {"Face Face.baked N00_000_00_FaceEyelash_00_FACE (Instance)", kLash},
      {"Face Face.baked N00_000_00_FaceEyeline_00_FACE (Instance)", kSkin},
      {"Body Body.baked N00_000_00_Body_00_SKIN (Instance)", kSkin},
      {"Body Body.baked N00_001_01_Tops_01_CLOTH (Instance)", kOther},
      {"Hair001 Hair001.baked N00_000_Hair_00_HAIR_01 (Instance)", kHair},
      // MakeHuman
      {"Human-eyelashes01 eyelashes01 Human:eyelashes01:Eyelashes01", kLash},
      {"Human-eyebrow001 eyebrow001 Human:eyebrow001:Eyebrow001", kSkin},
      {"Human-high-poly high-poly Human:high-poly:Eye_brown", kEye},
      {"Human-teeth_base teeth_base Human:teeth_base:Teeth", kTeeth},
      {"Human-tongue01 tongue01 Human:tongue01:Tongue", kTongue},
      {"Human-male_casualsuit01 male_casualsuit01 Human:male_casualsuit01", kOther},
      // Character Creator
      {"CC_Base_Eye CC_Base_Eye Std_Eye_L", kEye},
      {"CC_Base_Body CC_Base_Body Std_Eyelash", kLash},
      {"CC_Base_Teeth CC_Base_Teeth Std_Upper_Teeth", kTeeth},
      // ICT's face model
      {"eye_socket_left", kSkin},
      {"mouth_socket", kMouth},
      {"gums_and_tongue", kGum},
      // by hand, in Blender
      {"Eye.L Sphere.001 Material.002", kEye},
      {"lefteye", kEye},
      {"lefteyeball_geo", kEye},
      {"Lower teeth", kTeeth},
      {"tshirt", kOther}};
  for (const auto& [name, kind] : parts) {
    EXPECT_EQ(PartNames::BuiltIn().KindOf(name), kind) << name;
  }
}

TEST(PartNamesTest, AWordWithinAnotherSaysNothing) {
  for (const char* name :
       {"Solid", "that one", "Chair", "Hatch", "Argument", "", "0815", "Slide"}) {
    EXPECT_EQ(PartNames::BuiltIn().KindOf(name), kSkin) << name;
  }
  EXPECT_EQ(PartNames::BuiltIn().KindOf("Brown_Hair"), kHair);
}

TEST(PartNamesTest, TheFirstRowThatFitsCounts) {
  const PartNames names(Table("names", "other wig hair\nhair hair\neye *ball*"));
  EXPECT_EQ(names.KindOf("Hair"), kHair);
  EXPECT_EQ(names.KindOf("HairWig"), kOther);
  EXPECT_EQ(names.KindOf("wig"), kSkin) << "both words are asked for";
  EXPECT_EQ(names.KindOf("LEFTEYEBALLS"), kEye);
}

TEST(PartNamesTest, ARowThatIsNoneIsRefused) {
  EXPECT_THROW(PartNames(Table("names", "nose nose")), TableError);
  EXPECT_THROW(PartNames(Table("names", "eye")), TableError);
}

}  // namespace
}  // namespace fsm
