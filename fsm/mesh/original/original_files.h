#pragma once

#include <string>

namespace fsm {

/// The files of one face of the original (MaskFile, MaskEye, MaskTeeth); "" = not named.
struct OriginalFaceFiles {
  std::string name, picture, wireframe, eye_picture, eye_def, teeth_def;
};

/// The files that all faces of a configuration share; "" = not named.
struct OriginalSharedFiles {
  std::string standard, link;  ///< DEF_WFM_PNT, DEF_WFM_LNK
  std::string upper_teeth, lower_teeth, eye, mouth_picture;
  std::string offsets;   ///< the folder of _AU_Datas, _MU_Datas and _VM_Datas
  std::string config{};  ///< the configuration itself, for messages
};

}  // namespace fsm
