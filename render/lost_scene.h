// Why a scene is nearer to the truth with another table.
#pragma once

#include <string>

#include "render/film.h"
#include "render/scene.h"

namespace ltcfit {

/// One sentence: of the squared error that `film` has more than `other`, where it has more, the parts that
/// are too dark or too bright, at grazing views and in dark pixels; or that there is hardly a difference.
/// Films of the scene's size; pixels whose kinds differ are left out.
std::string explainLostScene(const Scene& scene, const Film& film, const Film& other, const Film& reference);

}  // namespace ltcfit
