// Memory in large pages.
#pragma once

namespace montelux {

// Moves the memory that this process has filled to pages of 2 MB where the system offers them: a scene is read at
// random, and most look-ups would first have to find a page of 4 KB. All of it is copied, so this is for memory that is
// read for long. Does nothing where the system does not offer such pages, or its administrator has switched them off.
void use_huge_pages();

}  // namespace montelux
