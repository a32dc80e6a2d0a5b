// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The worker, as seen from the page. A run that is not wanted any more ends with its worker, and another one takes its
// place.

export class Cancelled extends Error {}

async function compile(file) {
    const response = await fetch(file);
    if (!response.ok) throw new Error(`there is no ${file}`);
    return WebAssembly.compile(await response.arrayBuffer()); // whatever type the host says that it has
}

export class MatcherClient {
    // Threads share memory, which browsers allow if the host isolates the page from others.
    async start() {
        const documentation = await (await fetch('parameters.json')).json();
        const threads = globalThis.crossOriginIsolated ? navigator.hardwareConcurrency : 1;
        const start = async (name, count) => {
            this.engine = { name, module: await compile(`${name}.wasm`), documentation, threads: count };
            const started = await this.#startWorker();
            this.hasStarted = true;
            return { documentation, ...started };
        };
        if (threads > 1) {
            try {
                return await start('hdpstereo-threads', threads);
            } catch (error) {
                console.warn(`Without threads: ${error.message}`);
                this.#worker?.terminate();
            }
        }
        return start('hdpstereo', 1);
    }

    // Of the next match(); known: see dataOf() in known.mjs
    async setPair(left, right, known) {
        this.pair = { left, right, known };
        this.cancel();
        await this.#request('setPair', this.pair);
    }

    // The run for the images before is not waited for.
    decode(file, kind = 'image') {
        this.cancel();
        return this.#request('decode', { file, kind });
    }

    encode(request) {
        return this.#request('encode', request);
    }

    // A run that has not ended is cancelled.
    async match(settings) {
        this.cancel();
        return this.#request('match', { settings }, true);
    }

    setVideo(settings) {
        this.cancel();
        return this.#request('setVideo', { settings });
    }

    // isWhole: with sigma and reasons, which may be null if not
    frame(frame, isWhole) {
        return this.#request('frame', { frame, isWhole }, false, [frame.data.buffer]);
    }

    get isMatching() {
        return [...this.#waiting.values()].some(({ mayBeCancelled }) => mayBeCancelled);
    }

    cancel() {
        if (!this.isMatching) return;
        this.#worker.terminate();
        const ended = [...this.#waiting.values()];
        this.#waiting.clear();
        this.#restart();
        for (const { reject } of ended) reject(new Cancelled('cancelled'));
    }

    #worker = null;
    #waiting = new Map();
    #lastId = 0;

    #restart() {
        this.#worker.terminate();
        this.#startWorker().catch(() => {}); // what is asked of it next fails as well
        if (this.pair) this.#request('setPair', this.pair).catch(() => {});
    }

    #startWorker() {
        this.#worker = new Worker(new URL('worker.mjs', import.meta.url), { type: 'module' });
        this.#worker.onmessage = ({ data: { id, answer, error } }) => {
            const { resolve, reject } = this.#waiting.get(id) ?? {};
            this.#waiting.delete(id);
            if (error !== undefined) reject?.(new Error(error));
            else resolve?.(answer);
        };
        this.#worker.onerror = event => {
            const ended = [...this.#waiting.values()];
            this.#waiting.clear();
            if (this.hasStarted) this.#restart();
            for (const { reject } of ended) reject(new Error(event.message || 'The matcher stopped.'));
        };
        return this.#request('start', this.engine);
    }

    #request(action, request, mayBeCancelled = false, transfer = []) {
        const id = ++this.#lastId;
        return new Promise((resolve, reject) => {
            this.#waiting.set(id, { resolve, reject, mayBeCancelled });
            this.#worker.postMessage({ id, action, ...request }, transfer);
        });
    }
}
