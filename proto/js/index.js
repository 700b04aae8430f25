// A client of weft.v1 without dependencies, for browsers and Node. proto/README.md is the
// specification; messages.d.ts has the types of all messages.
//
//   import { WeftClient } from './index.js';
//   const weft = new WeftClient('ws://127.0.0.1:8080/ws');   // Node 20 and older: , { WebSocket } of ws
//   await weft.connect();
//   const hit = await weft.pick([0, 1, 3], [0, 0, -1]);
//   if (hit) {
//     const drag = weft.drag(hit, { radius: 0.05 });
//     drag.move([0, 1.5, 1]);
//   }

export { WeftClient } from './client.js';
export { Drag } from './drag.js';
export { CallTimeout, CommandError, ConnectionLost } from './errors.js';
export {
  ProtocolError,
  decodeBinary,
  decodeData,
  decodeFrame,
  decodeMesh,
  encodeAck,
} from './codec.js';
export { orderOf } from './order.js';
export { FrameReader } from './frames.js';
export { FrameDecoder } from './packed.js';
