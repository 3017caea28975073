// The interface of the library, for programs outside the source tree: find_package(Montelux), Montelux::montelux.
#pragma once
#include "montelux/render.h"
#include "montelux/result.h"
#include "montelux/scene.h"
#include "montelux/values.h"
