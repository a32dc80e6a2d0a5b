// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Frames with both images side by side, from a file or a camera, as fast as they can be matched

const widestFrame = 1920; // of both images together

export class Video {
    // match(frame) matches one; report(framesPerSecond) is called after each; fail(message) when it cannot go on.
    constructor({ match, report, fail }) {
        Object.assign(this, { match, report, fail });
        this.canvas = document.createElement('canvas');
        this.element = Object.assign(document.createElement('video'), { muted: true, loop: true, playsInline: true });
        this.generation = 0;
    }

    async openFile(file) {
        this.close();
        this.address = URL.createObjectURL(file);
        this.element.src = this.address;
        await this.#play(`${file.name} is not a video that this browser can play.`);
    }

    async openCamera() {
        this.close();
        let stream;
        try {
            stream = await navigator.mediaDevices.getUserMedia({ video: { width: { ideal: widestFrame } } });
        } catch {
            throw new Error('There is no camera, or this page may not use it.');
        }
        this.element.srcObject = stream;
        await this.#play('The camera has no picture.');
    }

    get isOpen() {
        return this.element.videoWidth > 0 && Boolean(this.address || this.element.srcObject);
    }

    get frameSize() {
        const { videoWidth, videoHeight } = this.element,
            scale = Math.min(1, widestFrame / videoWidth);
        return [2 * Math.floor((videoWidth * scale) / 2), Math.floor(videoHeight * scale)];
    }

    get isPaused() {
        return this.element.paused;
    }

    async togglePause() {
        if (this.element.paused) await this.element.play();
        else this.element.pause();
    }

    close() {
        this.generation++;
        this.element.pause();
        this.element.srcObject?.getTracks().forEach(track => track.stop());
        this.element.srcObject = null;
        this.element.removeAttribute('src');
        if (this.address) URL.revokeObjectURL(this.address);
        this.address = null;
    }

    async #play(message) {
        try {
            await this.element.play();
        } catch {
            this.close();
            throw new Error(message);
        }
    }

    // Until the video is closed or another one is opened
    async run() {
        const generation = ++this.generation,
            times = [];
        let lastTime = -1;
        while (generation === this.generation) {
            if (this.element.paused || this.element.currentTime === lastTime) {
                await new Promise(resolve => setTimeout(resolve, 5));
                continue;
            }
            lastTime = this.element.currentTime;
            try {
                await this.match(this.#frame(), () => generation === this.generation);
            } catch (error) {
                if (generation === this.generation) this.fail(error);
                return;
            }
            times.push(performance.now());
            if (times.length > 20) times.shift();
            if (generation === this.generation && times.length > 1)
                this.report((1000 * (times.length - 1)) / (times.at(-1) - times[0]));
            await new Promise(resolve => setTimeout(resolve)); // what the visitor does comes first
        }
    }

    #frame() {
        const [width, height] = this.frameSize;
        if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
        const context = this.canvas.getContext('2d', { willReadFrequently: true });
        context.drawImage(this.element, 0, 0, width, height);
        return { width, height, data: context.getImageData(0, 0, width, height).data };
    }
}
