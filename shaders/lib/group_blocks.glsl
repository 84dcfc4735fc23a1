// Which place of a work group a thread takes: in blocks of eight by four, so that threads that run together stand together.
const int BLOCK_WIDTH = 8, BLOCK_HEIGHT = 4;

// width  of the group, a multiple of a block's
ivec2 placeInBlocks(int width) {
  int thread = int(gl_LocalInvocationIndex), block = thread / (BLOCK_WIDTH * BLOCK_HEIGHT), along = width / BLOCK_WIDTH;
  return ivec2(block % along * BLOCK_WIDTH + thread % BLOCK_WIDTH,
               block / along * BLOCK_HEIGHT + thread / BLOCK_WIDTH % BLOCK_HEIGHT);
}
