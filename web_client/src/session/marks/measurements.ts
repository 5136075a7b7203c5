// What is measured in the scene.

import type {
  Measurement,
  MeasurementList,
  MeasurementsAddParams,
} from "heliograph/messages.ts";
import { Signal } from "../../common/signal.ts";
import { MarkStore, type MarksHost } from "./mark_store.ts";

export type LengthUnit = MeasurementList["unit"];

export class Measurements extends MarkStore<Measurement, MeasurementList, MeasurementsAddParams> {
  readonly unit = new Signal<LengthUnit>("m");

  constructor(host: MarksHost) {
    const { rpc } = host;
    super(host, {
      method: "measurements.list",
      list: () => rpc.request("measurements.list"),
      add: (request) => rpc.request("measurements.add", request),
      remove: (id) => rpc.request("measurements.remove", { id }),
      clear: () => rpc.request("measurements.clear"),
      itemsOf: ({ measurements }) => measurements,
      requestOf: ({ id, kind, points, nodes }) => ({ id, kind, points, nodes }),
      nameOf: describeKind,
      moves: ({ points }) => points.some(({ surface }) => surface),
    });
  }

  override take(list: MeasurementList): void {
    this.unit.set(list.unit);
    super.take(list);
  }

  override async restore(): Promise<void> {
    const unit = this.unit.value;
    await super.restore();
    if (this.list.value.length > 0 && unit !== this.unit.value) await this.setUnit(unit);
  }

  async setUnit(unit: LengthUnit): Promise<void> {
    await this.change(() => this.host.rpc.request("measurements.unit", { unit }));
  }
}

export function describeKind({ kind }: Pick<Measurement, "kind">): string {
  return { distance: "Distance", angle: "Angle", size: "Size" }[kind];
}
