// The whole shading check of a table: scenes drawn by GL, by the double-precision twin and by Monte Carlo.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/gl_context.h"
#include "render/picture_error.h"
#include "render/scenes.h"
#include "render/shader_table.h"
#include "render/twin.h"

namespace ltcfit {

/// GL against the twin, dB: what a scene must reach with a table of halves, whatever it must with floats.
inline constexpr double kHalfPsnrFloor = 40.0;

/// Whether its textures hold halves.
inline bool isHalf(const ShaderTable& table) {
  return table.textures[0].precision == Precision::kHalf;
}

struct ShadingCheckOptions {
  std::optional<CustomScene> custom;  ///< this one instead of all others
  std::size_t width = 160;            ///< of named scenes, pixels
  std::size_t height = 120;
  std::size_t randomScenes = 256;    ///< a quarter of them once more with dielectricF0
  double dielectricF0 = 0.04;        ///< 0..1
  std::size_t randomSize = 32;       ///< pixels along each side
  std::uint64_t seed = 1;            ///< of random scenes and of the reference's samples
  std::size_t maxSamples = 1 << 16;  ///< of each strategy and light at a pixel of the reference
  int threads = 0;                   ///< 0: all cores. Does not change a figure but the frame times
};

/// One scene, drawn and judged.
struct SceneCheck {
  CheckScene check;
  bool random = false;
  PictureError gl;       ///< GL against the twin; its PSNR is of the twin's brightest pixel, 1 at most
  double glFloor = 0.0;  ///< dB, by the table's precision
  bool passed = false;   ///< GL is as near to the twin as asked, no pixel is NaN

  Film ltc;                           ///< by GL
  Film reference;                     ///< the true light
  double referenceRmse = 0.0;         ///< its own error, from the spread of its randomisations
  double referenceSamples = 0.0;      ///< of each strategy and light, mean over pixels
  PictureError error;                 ///< GL against the reference
  std::optional<Film> otherLtc;       ///< the table compared with, by GL
  std::optional<PictureError> other;  ///< it against the reference
  std::string explanation;            ///< where the other table is closer: why
  /// RMSE of the twin against the reference, by HorizonClipping; none for textured lights.
  std::optional<std::array<double, kHorizonClippings>> clipping;

  /// Whether the reference's own error is at most a tenth of what it judges.
  bool resolved() const;
  /// Nearer to the reference than the other table, by more than the reference's own error.
  bool closer() const;
  /// Farther from it.
  bool lost() const { return other && error.rmse > other->rmse; }
};

/// Means over random scenes.
struct RandomSummary {
  std::size_t scenes = 0;
  double rmse = 0.0;
  double otherRmse = 0.0;
  double geometricRatio = 0.0;  ///< geometric mean of the ratios of the RMSEs, every scene alike
  std::size_t closer = 0;       ///< SceneCheck::closer
  std::size_t lost = 0;  ///< SceneCheck::lost; what remains is closer by less than the reference is exact
  std::size_t resolved = 0;
  double referenceRmse = 0.0;
  std::array<double, kHorizonClippings> clipping{};
};
RandomSummary summaryOf(std::span<const SceneCheck> scenes);

struct FrameTime {
  std::string scene;
  double seconds = 0.0;  ///< median
};

struct ShadingCheck {
  std::string renderer;                 ///< as GL names itself
  std::vector<SceneCheck> scenes;       ///< named ones, then random ones
  std::vector<SceneCheck> dielectrics;  ///< the first random ones with the option's F0
  std::vector<FrameTime> frames;        ///< at kFrameWidth x kFrameHeight

  bool passed() const;
  RandomSummary random() const;  ///< of the random ones among the scenes
};

inline constexpr std::size_t kFrameWidth = 1280;
inline constexpr std::size_t kFrameHeight = 720;

/// Draws and judges all scenes that the table's kind can shade; where it or the other has no fresnel, those
/// of f0 = 1. `other`, if any, is a table to compare with, of the same kind. Calls `progress(done, total)` in
/// units of scenes. GlError where GL fails.
ShadingCheck runShadingCheck(const ShaderTable& table, const ShaderTable* other,
                             const ShadingCheckOptions& options,
                             const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace ltcfit
