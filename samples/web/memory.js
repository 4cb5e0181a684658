// SPDX-License-Identifier: Apache-2.0
// memory.js: WASI (preview 1) for one run of a command in a browser. Its files are in memory, all in one folder: a
// name in a folder below, as glTF files use them, means the file with its last name.

const kErrors = { badFile: 8, exists: 20, invalid: 28, isFolder: 31, absent: 44, unknown: 52, noFolder: 54, noSeek: 70 };
const kDevice = 2, kFolder = 3, kFile = 4;
const kRoot = 3, kError = 2;
const kSeekAndTell = (1n << 2n) | (1n << 5n), kAll = (1n << 30n) - 1n;

export class Exit extends Error {
  constructor(status) {
    super(`status ${status}`);
    this.status = status;
  }
}

class Failure extends Error {
  constructor(number) {
    super(`errno ${number}`);
    this.number = number;
  }
}

const fail = (what) => {
  throw new Failure(kErrors[what]);
};

class MemoryFile {
  static #last = 1n;
  constructor(bytes = new Uint8Array(0)) {
    this.bytes = bytes;
    this.size = bytes.length;
    this.id = ++MemoryFile.#last;
    this.time = BigInt(Date.now()) * 1000000n;
  }
  read(position, target) {
    const part = this.bytes.subarray(position, Math.min(this.size, position + target.length));
    target.set(part);
    return part.length;
  }
  write(position, from) {
    this.resize(Math.max(this.size, position + from.length));
    this.bytes.set(from, position);
    return from.length;
  }
  resize(size) {
    if (size > this.bytes.length) {
      const larger = new Uint8Array(Math.max(size, 2 * this.bytes.length));
      larger.set(this.bytes.subarray(0, this.size));
      this.bytes = larger;
    }
    if (size < this.size) this.bytes.fill(0, size, this.size);
    this.size = size;
  }
}

export class Memory {
  #memory;
  #open = new Map([[0, {}], [1, { stream: 1 }], [kError, { stream: kError }], [kRoot, { folder: true }]]);

  /** `files`: names and bytes; `print(stream, bytes)` gets what is printed, a terminal's progress on stream 2. */
  constructor(args, files, print) {
    this.args = args;
    this.print = print;
    this.files = new Map([...files].map(([name, bytes]) => [name, new MemoryFile(bytes)]));
    this.given = new Map([...this.files].map(([name, file]) => [name, file.id]));
  }

  /** What the run has written: [name, bytes]. */
  written() {
    const made = [...this.files].filter(([name, file]) => this.given.get(name) !== file.id);
    return made.map(([name, file]) => [name, file.bytes.slice(0, file.size)]);
  }

  imports(memory) {
    this.#memory = memory;
    const wrapped = {};
    for (const [name, call] of Object.entries(this.#calls())) {
      wrapped[name] = (...values) => {
        try {
          return call(...values) ?? 0;
        } catch (error) {
          if (error instanceof Failure) return error.number;
          throw error;
        }
      };
    }
    return new Proxy(wrapped, { get: (known, name) => known[name] ?? (() => kErrors.unknown) });
  }

  get #view() {
    return new DataView(this.#memory().buffer);
  }
  #bytes(at, count) {
    return new Uint8Array(this.#memory().buffer, at >>> 0, count >>> 0);
  }
  #file(number) {
    return this.#open.get(number) ?? fail('badFile');
  }
  /** A name without folders: "" for the folder itself. */
  #name(at, count) {
    const parts = new TextDecoder().decode(this.#bytes(at, count)).split('/').filter((part) => part !== '' && part !== '.');
    return parts.at(-1) === '..' ? '' : (parts.at(-1) ?? '');
  }
  #found(at, count) {
    return this.files.get(this.#name(at, count)) ?? fail('absent');
  }
  #strings(list) {
    const encoded = list.map((text) => new TextEncoder().encode(`${text}\0`));
    const sizes = (count, size) => {
      this.#view.setUint32(count, encoded.length, true);
      this.#view.setUint32(size, encoded.reduce((sum, { length }) => sum + length, 0), true);
    };
    const get = (pointers, at) => {
      for (const [k, bytes] of encoded.entries()) {
        this.#view.setUint32(pointers + 4 * k, at, true);
        this.#bytes(at, bytes.length).set(bytes);
        at += bytes.length;
      }
    };
    return { sizes, get };
  }
  #status(at, file) {
    const values = [1n, file?.id ?? 1n, BigInt(file ? kFile : kFolder), 1n, BigInt(file?.size ?? 0)];
    values.push(...Array(3).fill(file?.time ?? 0n));
    for (const [k, value] of values.entries()) this.#view.setBigUint64(at + 8 * k, value, true);
  }
  /** Moves bytes between buffers and an open file. */
  #move(number, buffers, count, position, done, move) {
    const open = this.#file(number);
    if (open.folder) fail('isFolder');
    let total = 0;
    for (let k = 0; k < count; ++k) {
      const [at, length] = [0, 4].map((byte) => this.#view.getUint32(buffers + 8 * k + byte, true));
      const moved = move(open, this.#bytes(at, length), (position ?? open.at ?? 0) + total);
      total += moved;
      if (moved < length) break;
    }
    if (position === undefined && open.file) open.at += total;
    this.#view.setUint32(done, total, true);
  }
  #read(...values) {
    this.#move(...values, (open, bytes, at) => (open.file ? open.file.read(at, bytes) : 0));
  }
  #write(...values) {
    this.#move(...values, (open, bytes, at) => {
      if (open.file) return open.file.write(at, bytes);
      this.print(open.stream, bytes.slice());
      return bytes.length;
    });
  }
  #openName(at, count, how, result) {
    const [create, folder, exclusive, truncate] = [1, 2, 4, 8].map((bit) => (how & bit) !== 0);
    const name = this.#name(at, count);
    let file = this.files.get(name);
    if (name !== '' && folder) fail(file ? 'noFolder' : 'absent');
    if (file && create && exclusive) fail('exists');
    if (name !== '' && !file && !create) fail('absent');
    if (name !== '' && (!file || truncate)) this.files.set(name, (file = new MemoryFile()));
    let number = kRoot + 1;
    while (this.#open.has(number)) ++number;
    this.#open.set(number, name === '' ? { folder: true } : { file, at: 0 });
    this.#view.setUint32(result, number, true);
  }
  #readFolder(at, count, cookie, used) {
    const entries = [...this.files.keys()].slice(Number(cookie)), target = this.#bytes(at, count);
    let length = 0;
    for (const [k, name] of entries.entries()) {
      const text = new TextEncoder().encode(name), entry = new Uint8Array(24 + text.length);
      const view = new DataView(entry.buffer);
      view.setBigUint64(0, cookie + BigInt(k) + 1n, true);
      view.setBigUint64(8, this.files.get(name).id, true);
      view.setUint32(16, text.length, true);
      view.setUint8(20, kFile);
      entry.set(text, 24);
      const part = entry.subarray(0, count - length);
      target.set(part, length);
      length += part.length;
      if (length === count) break;
    }
    this.#view.setUint32(used, length, true);
  }

  #calls() {
    const args = this.#strings(this.args), env = this.#strings(['PWD=/', 'TERM=xterm', 'NO_COLOR=1']);
    const set64 = (at, value) => this.#view.setBigUint64(at, value, true);
    return {
      args_get: args.get,
      args_sizes_get: args.sizes,
      environ_get: env.get,
      environ_sizes_get: env.sizes,
      clock_time_get: (clock, _, at) =>
        set64(at, BigInt(Math.round(((clock === 0 ? performance.timeOrigin : 0) + performance.now()) * 1e3)) * 1000n),
      random_get: (at, count) => void crypto.getRandomValues(this.#bytes(at, count)),
      sched_yield: () => 0,
      proc_exit: (status) => {
        throw new Exit(status);
      },
      fd_close: (number) => void this.#open.delete(number),
      fd_datasync: () => 0,
      fd_sync: () => 0,
      fd_advise: () => 0,
      fd_fdstat_get: (number, at) => {
        const open = this.#file(number);
        set64(at, BigInt(open.folder ? kFolder : open.file ? kFile : kDevice));
        set64(at + 8, open.stream === kError ? kAll & ~kSeekAndTell : kAll); // that is how a terminal is known
        set64(at + 16, kAll);
      },
      fd_filestat_get: (number, at) => {
        const open = this.#file(number);
        this.#status(at, open.file);
        if (open.stream || number === 0) set64(at + 16, BigInt(kDevice));
      },
      fd_filestat_set_size: (number, size) => this.#file(number).file.resize(Number(size)),
      fd_prestat_get: (number, at) => (number === kRoot ? set64(at, 1n << 32n) : fail('badFile')),
      fd_prestat_dir_name: (_, at) => void this.#bytes(at, 1).fill(0x2f),
      fd_read: (number, buffers, count, done) => this.#read(number, buffers, count, undefined, done),
      fd_write: (number, buffers, count, done) => this.#write(number, buffers, count, undefined, done),
      fd_pread: (number, buffers, count, at, done) => this.#read(number, buffers, count, Number(at), done),
      fd_pwrite: (number, buffers, count, at, done) => this.#write(number, buffers, count, Number(at), done),
      fd_readdir: (_, ...values) => this.#readFolder(...values),
      fd_seek: (number, by, from, at) => {
        const open = this.#file(number);
        if (!open.file) fail('noSeek');
        open.at = Number(by) + [0, open.at, open.file.size][from];
        set64(at, BigInt(open.at));
      },
      path_filestat_get: (_, __, at, count, to) =>
        this.#status(to, this.#name(at, count) === '' ? undefined : this.#found(at, count)),
      path_open: (_, __, at, count, how, ___, ____, _____, result) => this.#openName(at, count, how, result),
      path_readlink: (_, at, count) => (this.#name(at, count) === '' || this.#found(at, count), fail('invalid')),
      path_unlink_file: (_, at, count) => void (this.#found(at, count), this.files.delete(this.#name(at, count))),
      path_rename: (_, at, count, __, to, length) => {
        const file = this.#found(at, count);
        this.files.delete(this.#name(at, count));
        this.files.set(this.#name(to, length), file);
      },
    };
  }
}
