// The socket to the server: requests that are answered, events, frames, and a new socket when one breaks.

import { decode, type Frame } from './frames';
import type { Failure, Json, ServerEvent } from './protocol';

/** What the server refused, with its sentence, place and remedy. */
export class Refusal extends Error {
  constructor(readonly failure: Failure) {
    super(failure.sentence);
  }
}

interface Waiting {
  resolve: (value: any) => void;
  reject: (reason: Refusal) => void;
}

export interface Listener {
  event(event: ServerEvent): void;
  frame(frame: Frame): void;
  connected(open: boolean): void;
}

export class Connection {
  private socket: WebSocket | undefined;
  private waiting = new Map<number, Waiting>();
  private queue: string[] = [];
  private next = 1;
  private delay = 250;

  constructor(private listener: Listener) {
    this.open();
  }

  /** Sends a request; resolves with the answer, or throws a `Refusal`. */
  ask<T = Json>(what: string, keys: object = {}): Promise<T> {
    const id = this.next++;
    const text = JSON.stringify({ id, do: what, ...keys });
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(text);
      else this.queue.push(text);
    });
  }

  private open() {
    const address = new URL('socket', location.href);
    address.protocol = location.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = new WebSocket(address);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.delay = 250;
      this.listener.connected(true);
      for (const text of this.queue.splice(0)) socket.send(text);
    };
    socket.onmessage = ({ data }) => {
      if (data instanceof ArrayBuffer) this.listener.frame(decode(data));
      else this.text(JSON.parse(data as string));
    };
    socket.onclose = () => {
      this.listener.connected(false);
      // What was asked is not known to have happened.
      const lost = new Refusal({ sentence: 'The connection to the studio was lost.' });
      for (const { reject } of this.waiting.values()) reject(lost);
      this.waiting.clear();
      this.queue = [];
      setTimeout(() => this.open(), this.delay);
      this.delay = Math.min(2 * this.delay, 4000);
    };
    this.socket = socket;
  }

  private text(message: { re?: number; ok?: Json; error?: Failure } & Partial<ServerEvent>) {
    if (message.re === undefined) {
      this.listener.event(message as ServerEvent);
      return;
    }
    const waiting = this.waiting.get(message.re);
    this.waiting.delete(message.re);
    if (message.error) waiting?.reject(new Refusal(message.error));
    else waiting?.resolve(message.ok ?? {});
  }
}

/** The address of a file below the server's root. */
export function fileAddress(path: string): string {
  return `file?path=${encodeURIComponent(path)}`;
}

/** Puts a file below the server's root; answers its path there. */
export async function upload(file: File): Promise<string> {
  const response = await fetch(`upload?name=${encodeURIComponent(file.name)}`, { method: 'POST', body: file });
  if (!response.ok) throw new Refusal({ sentence: `${file.name} was not taken: ${await response.text()}` });
  return ((await response.json()) as { path: string }).path;
}
