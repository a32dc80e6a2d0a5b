// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The points of a map, to turn

import {
    BufferAttribute,
    BufferGeometry,
    OrbitControls,
    PerspectiveCamera,
    Points,
    PointsMaterial,
    Scene,
    WebGLRenderer,
} from './vendor/three.mjs';
import { colorReader, forEachPoint } from './downloads.mjs';

const mostPoints = 1e6;

export class PointCloud {
    constructor(parent) {
        this.parent = parent;
        try {
            this.renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
        } catch {
            throw new Error('This browser has no WebGL, which the point cloud needs.');
        }
        this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
        const canvas = this.renderer.domElement;
        canvas.tabIndex = 0;
        canvas.setAttribute('role', 'img');
        canvas.setAttribute('aria-label', 'Point cloud: drag to turn, wheel to come nearer, arrow keys to turn');
        parent.append(canvas);
        this.scene = new Scene();
        this.camera = new PerspectiveCamera(45, 1, 0.001, 1000);
        this.orbit = new OrbitControls(this.camera, canvas);
        this.orbit.addEventListener('change', () => this.#render());
        canvas.onkeydown = event => this.#turn(event);
        new ResizeObserver(() => this.#resize()).observe(parent);
    }

    // Depths in units of the median one
    show(result, view) {
        this.points?.geometry.dispose();
        this.points?.material.dispose();
        this.scene.clear();
        const pixels = result.width * result.height,
            step = Math.ceil(Math.sqrt(pixels / mostPoints));
        const places = [],
            colors = [],
            color = colorReader(result.left),
            toLinear = level => (level / 255) ** 2.2;
        forEachPoint(
            { ...result, ...view },
            (x, y, z, i) => {
                places.push(x, -y, -z);
                colors.push(toLinear(color(i, 0)), toLinear(color(i, 1)), toLinear(color(i, 2)));
            },
            step,
        );
        const depths = places.filter((_, i) => i % 3 === 2).sort((a, b) => b - a);
        const unit = -depths[Math.floor(depths.length / 2)] || 1;
        const near = -depths[Math.floor(0.02 * depths.length)] / unit;
        const geometry = new BufferGeometry();
        geometry.setAttribute(
            'position',
            new BufferAttribute(
                Float32Array.from(places, value => value / unit),
                3,
            ),
        );
        geometry.setAttribute('color', new BufferAttribute(Float32Array.from(colors), 3));
        this.spacing = (1.25 * step) / view.focal;
        this.points = new Points(geometry, new PointsMaterial({ size: this.spacing, vertexColors: true }));
        this.scene.add(this.points);
        this.fieldOfView = (2 * Math.atan((0.5 * result.height) / view.focal) * 180) / Math.PI;
        const middle = Number.isFinite(near) ? 0.5 * (near + 1) : 1;
        this.orbit.target.set(0, 0, -middle);
        this.camera.position.set(-0.22 * middle, 0.14 * middle, 0.1);
        this.orbit.update();
        this.#resize();
    }

    #turn(event) {
        const turns = { ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
        if (!(event.key in turns)) return;
        event.preventDefault();
        const [across, up] = turns[event.key],
            offset = this.camera.position.clone().sub(this.orbit.target);
        const radius = offset.length(),
            angle = Math.atan2(offset.x, offset.z) + across;
        const height = Math.min(Math.max(Math.asin(offset.y / radius) + up, -1.4), 1.4);
        offset.set(Math.sin(angle) * Math.cos(height), Math.sin(height), Math.cos(angle) * Math.cos(height));
        this.camera.position.copy(this.orbit.target).addScaledVector(offset, radius);
        this.orbit.update();
    }

    #resize() {
        const { clientWidth: width, clientHeight: height } = this.parent;
        if (!width || !height || !this.points) return;
        this.renderer.setSize(width, height);
        this.camera.aspect = width / height;
        this.camera.fov = Math.max(this.fieldOfView * 1.05, 10);
        this.camera.updateProjectionMatrix();
        this.#render();
    }

    #render() {
        this.renderer.render(this.scene, this.camera);
    }
}
