# Fetches the packages of package-lock.json into the working folder; tries again, since networks fail now and then.
foreach(attempt RANGE 1 3)
  execute_process(COMMAND ${NPM} ci --include=dev --no-progress --loglevel=error RESULT_VARIABLE status
                  OUTPUT_QUIET)
  if(status EQUAL 0)
    return()
  endif()
  message(STATUS "npm ci failed (attempt ${attempt} of 3)")
endforeach()
message(FATAL_ERROR "The packages of the page of reports cannot be fetched (npm ci, see above). Without them configure "
                    "with -DMONTELUX_WEB=OFF: the program then writes JSON, CSV and SVG, but no HTML.")
