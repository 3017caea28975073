// Memory in large pages.
#pragma once

namespace montelux {

// Moves the memory that this process has filled to pages of 2 MB where the system offers them: a scene is read at
// random, and most look-ups would first have to find a page of 4 KB. Takes about 1 ms for 10 MB, so it is for memory
// that is read for long. Changes nothing where the system does not offer such pages.
void use_huge_pages();

}  // namespace montelux
