# Installs the charting library of the report's page from npm into FOLDER, as PAGE/package-lock.json pins it, and
# writes FOLDER/charts.js. Nothing is done while that lock file is the one installed. A failure (no npm, no network) is
# no failure of the build: charts.js is then empty, FOLDER/missing.txt says why, and the next run tries again.
#   cmake -DNPM=... -DPAGE=... -DFOLDER=... -P fetch_charts.cmake
file(MAKE_DIRECTORY ${FOLDER})
set(lock ${PAGE}/package-lock.json)
set(stamp ${FOLDER}/installed-package-lock.json)
set(library ${FOLDER}/node_modules/echarts/dist/echarts.min.js)
file(SHA256 ${lock} wanted)
if(EXISTS ${stamp} AND EXISTS ${library} AND EXISTS ${FOLDER}/charts.js)
  file(SHA256 ${stamp} installed)
  if(installed STREQUAL wanted)
    file(REMOVE ${FOLDER}/missing.txt)
    return()
  endif()
endif()
file(REMOVE ${stamp})
if(NPM)
  message("fetching the charting library of the report's page (npm; seconds, two minutes at most)")
  file(COPY ${PAGE}/package.json ${lock} DESTINATION ${FOLDER})
  # a registry that does not answer costs two tries of half a minute
  execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline --fetch-timeout=30000
                          --fetch-retries=1 --fetch-retry-mintimeout=1000 --fetch-retry-maxtimeout=2000
                  WORKING_DIRECTORY ${FOLDER} TIMEOUT 120 RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE messages)
  if(result EQUAL 0 AND EXISTS ${library})
    file(COPY_FILE ${library} ${FOLDER}/charts.js ONLY_IF_DIFFERENT)
    file(COPY_FILE ${lock} ${stamp})
    file(REMOVE ${FOLDER}/missing.txt)
    return()
  endif()
  # npm's own reason: the line of the request that failed, else its first one
  if(NOT messages MATCHES "npm (ERR!|error) ([^\n]*reason: [^\n]*)")
    string(REGEX MATCH "npm (ERR!|error) ([^\n]*)" found "${messages}")
  endif()
  if(CMAKE_MATCH_2)
    set(reason "npm could not fetch it: ${CMAKE_MATCH_2}")
  else()
    set(reason "npm could not fetch it: ${result}")
  endif()
else()
  set(reason "npm is not installed")
endif()
file(WRITE ${FOLDER}/missing.txt "${reason}\n")
file(WRITE ${FOLDER}/charts.js "")
message("no charting library (${reason}): built without `ltcfit report`; everything else is made. The next "
        "configuration tries again")
