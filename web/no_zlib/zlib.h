// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef HDPSTEREO_NO_ZLIB_H
#define HDPSTEREO_NO_ZLIB_H

// OpenCV's core reads and writes compressed files by zlib. A web page has no files: none can be opened here. Its build
// asks for a version.
// opened here.

#define ZLIB_VERSION "1.2.13"

typedef struct gzFile_s* gzFile;

static inline gzFile gzopen(const char*, const char*) { return 0; }
static inline int gzputs(gzFile, const char*) { return -1; }
static inline char* gzgets(gzFile, char*, int) { return 0; }
static inline int gzeof(gzFile) { return 1; }
static inline int gzrewind(gzFile) { return -1; }
static inline int gzclose(gzFile) { return -1; }

#endif
