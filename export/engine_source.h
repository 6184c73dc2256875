// Source files of engines that compile their table in.
#pragma once

#include <string>

#include "export/packing.h"

namespace ltcfit {

/// Blender's eevee_lut.cc: float ltc_mat_ggx[64][64][4], ltc_mag_ggx[64][64][2],
/// ltc_disk_integral[64][64][1], under the names of the packing's textures.
std::string texturesToBlender(const PackedTable& packed);

/// Unreal's LTC.h: LTC_Size, LTCMat[..][4], LTCAmp[..][2].
std::string texturesToUnreal(const PackedTable& packed);

/// HDRP's LtcData: ushort[] s_LtcMatrixData_GGX with the bits of halves, 4 a texel.
std::string texturesToUnity(const PackedTable& packed);

}  // namespace ltcfit
