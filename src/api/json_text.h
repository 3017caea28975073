// JSON as text, for programs over the facade.
#pragma once
#include "io/json_text.h"
