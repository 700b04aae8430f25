import { FrameReader } from '../../../proto/js/index.js';
import type { FromFrameWorker, ToFrameWorker } from './worker_frames.js';

// Decodes frames beside the page's own thread, which has pictures to draw.

const reader = new FrameReader();

function answer(bytes: ArrayBuffer): FromFrameWorker {
  try {
    return { received: reader.take(bytes) };
  } catch (error) {
    return { fault: error instanceof Error ? error.message : String(error) };
  }
}

self.onmessage = ({ data }: MessageEvent<ToFrameWorker>) => {
  if ('cloths' in data) return reader.begin(data.cloths, data);
  const reply = answer(data.bytes);
  const frame = 'received' in reply ? reply.received.frame : null;
  const transfer = frame ? [frame.positions.buffer as ArrayBuffer] : [];
  self.postMessage(reply, { transfer });
};
