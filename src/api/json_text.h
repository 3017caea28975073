// JSON as text, for programs that use the facade.
#pragma once
#include "io/json_text.h"
