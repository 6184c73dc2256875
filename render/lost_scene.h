// Why a scene is nearer to the truth with another table.
#pragma once

#include <string>

#include "render/film.h"
#include "render/scene.h"

namespace ltcfit {

/// One sentence on where the excess of squared error of `film` over that of `other` lies: in the dark, at
/// grazing views, in a highlight that is too dark or too bright; or that there is hardly any. Films of the
/// scene's size, surface pixels that differ in kind left out.
std::string explainLostScene(const Scene& scene, const Film& film, const Film& other, const Film& reference);

}  // namespace ltcfit
