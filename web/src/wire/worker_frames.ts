import { FrameReader, ProtocolError } from '../../../proto/js/index.js';
import type { FrameSource, Received } from '../../../proto/js/frames.js';
import type { Cloth } from '../../../proto/js/messages.js';

const SEQUENCE_AT = 40; // in the bytes of a frame
const FIXED_BYTES = 64; // of a frame

interface Mesh {
  cloths: Cloth[];
  restPositions: Float32Array;
  order: Uint32Array | null;
}
export type ToFrameWorker = Mesh | { bytes: ArrayBuffer };
export type FromFrameWorker = { received: Received } | { fault: string };

interface Waiting {
  sequence: number;
  done: (received: Received) => void;
  fail: (error: Error) => void;
}

/** Has frames decoded by a worker; where none can run, by itself. */
export class WorkerFrames implements FrameSource {
  private waiting: Waiting[] = [];
  private mesh: Mesh | null = null;
  private own: FrameReader | null = null; // once the worker has failed
  private readonly worker: Worker;

  constructor(worker: Worker) {
    this.worker = worker;
    worker.onmessage = ({ data }: MessageEvent<FromFrameWorker>) => {
      const next = this.waiting.shift();
      if (!next) return;
      if ('received' in data) next.done(data.received);
      else next.fail(new ProtocolError(data.fault));
    };
    worker.onerror = () => this.go_on_alone();
  }

  begin(cloths: Cloth[], { restPositions, order }: Omit<Mesh, 'cloths'>): void {
    this.mesh = { cloths, restPositions, order };
    if (this.own) this.own.begin(cloths, this.mesh);
    else this.worker.postMessage(this.mesh satisfies ToFrameWorker);
  }

  read(bytes: ArrayBuffer, done: Waiting['done'], fail: Waiting['fail']): void {
    if (this.own || bytes.byteLength < FIXED_BYTES) {
      done((this.own ?? new FrameReader()).take(bytes));
      return;
    }
    const sequence = new DataView(bytes).getUint32(SEQUENCE_AT, true);
    this.waiting.push({ sequence, done, fail });
    this.worker.postMessage({ bytes } satisfies ToFrameWorker, [bytes]);
  }

  /** What the worker had is lost, so that a key frame is needed. */
  private go_on_alone(): void {
    if (this.own) return;
    this.own = new FrameReader();
    if (this.mesh) this.own.begin(this.mesh.cloths, this.mesh);
    for (const { sequence, done } of this.waiting.splice(0)) done({ sequence, frame: null });
  }
}
